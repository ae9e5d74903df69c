// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the 3D view: bodies, the pieces that are in contact, contacts, and the force.
// Lengths are metres from the tool's first position. Drawn when something changes, not all the time.
import {
  AmbientLight, ArrowHelper, Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, Group, Mesh,
  MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Points, PointsMaterial, Scene, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { counts, floats } from './data.js';

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function shapeOf(image) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(floats(image.points), 3));
  geometry.setIndex(new BufferAttribute(counts(image.faces), 1));
  geometry.computeVertexNormals();
  return geometry;
}

/// The triangles of some pieces of one image, with the colour of each one's level.
class Pieces {
  constructor(image, colourOfLevel) {
    this.starts = counts(image.pieces.starts);
    this.corners = floats(image.pieces.corners);
    this.levels = image.levels;
    this.colourOfLevel = colourOfLevel;
  }

  /// sides: [{place, level}]; a piece is drawn once.
  fill(geometry, sides) {
    const chosen = new Map(sides.filter((s) => s.place !== null).map((s) => [s.place, s.level]));
    let triangles = 0;
    for (const place of chosen.keys()) triangles += this.starts[place + 1] - this.starts[place];
    const positions = new Float32Array(9 * triangles);
    const colours = new Float32Array(9 * triangles);
    let end = 0;
    for (const [place, level] of chosen) {
      const run = this.corners.subarray(9 * this.starts[place], 9 * this.starts[place + 1]);
      positions.set(run, end);
      const { r, g, b } = new Color(this.colourOfLevel(level, this.levels));
      for (let i = 0; i < run.length; i += 3) colours.set([r, g, b], end + i);
      end += run.length;
    }
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('color', new BufferAttribute(colours, 3));
    geometry.computeVertexNormals();
  }
}

export class Stage {
  #scene = new Scene();
  #camera = new PerspectiveCamera(40, 1, 0.01, 100);
  #bodies = [];
  #contactPoints = new Points(new BufferGeometry(), new PointsMaterial({ size: 7, sizeAttenuation: false, vertexColors: true, depthTest: false }));
  #arrow = new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), 1, 0x888888);
  #pending = false;
  #contacts = [];
  #frame = 0;

  /// Throws where the browser has no WebGL.
  constructor(host, view, times) {
    this.host = host;
    this.view = view;
    this.times = times;
    this.forces = floats(view.force_N);
    this.tracks = view.bodies.map((body) => floats(body.track));
    this.size = Math.max(...view.bodies.map((body) => view.images[body.image].radius_m));
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    host.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute('aria-label', 'Both bodies and their contacts in 3D');
    this.renderer.domElement.setAttribute('role', 'img');
    this.#addLights();
    this.#addBodies();
    this.#contactPoints.renderOrder = 3;
    this.#contactPoints.frustumCulled = false;
    this.#scene.add(this.#contactPoints, this.#arrow);
    for (const part of [this.#arrow.line, this.#arrow.cone]) {
      part.material.depthTest = false;
      part.renderOrder = 4;
    }
    this.#camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.#camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.#draw());
    new ResizeObserver(() => this.#resize()).observe(host);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.#paint());
    this.#resize();
    this.#paint();
  }

  /// From amber, the finest, by green and blue to violet, the coarsest.
  colourOfLevel(level, levels) {
    const share = levels > 1 ? level / (levels - 1) : 0;
    return `#${new Color().setHSL(0.11 + 0.66 * share, 0.8, 0.56 - 0.1 * share).getHexString()}`;
  }

  /// The frame in which the tool feels most.
  strongestFrame() {
    let best = 0;
    for (let frame = 1; 3 * frame < this.forces.length; ++frame) {
      if (Math.hypot(...this.forceAt(frame)) > Math.hypot(...this.forceAt(best))) best = frame;
    }
    return best;
  }

  forceAt(frame) {
    return this.forces.subarray(3 * frame, 3 * frame + 3);
  }

  positionOf(body, frame) {
    return this.tracks[body].subarray(7 * frame, 7 * frame + 3);
  }

  show(frame, contacts) {
    this.#frame = frame;
    this.#contacts = contacts;
    this.#bodies.forEach((body, index) => {
      const track = this.tracks[index].subarray(7 * frame, 7 * frame + 7);
      body.group.position.fromArray(track, 0);
      body.group.quaternion.fromArray(track, 3);
      const sides = contacts.flatMap((c) => [c.a, c.b]).filter((side) => side.body === index);
      body.pieces.fill(body.patch.geometry, sides);
    });
    this.#showContacts();
    this.#showForce();
    this.#draw();
  }

  setLook(index, look) {
    const { mesh, patch } = this.#bodies[index];
    mesh.visible = look !== 'hidden';
    mesh.material.transparent = look === 'see-through';
    mesh.material.opacity = look === 'see-through' ? 0.3 : 1;
    mesh.material.depthWrite = look === 'solid';
    mesh.material.needsUpdate = true;
    patch.visible = look !== 'hidden';
    this.#draw();
  }

  lookAtAll() {
    this.#scene.updateMatrixWorld();
    const box = new Box3();
    for (const { mesh } of this.#bodies) box.expandByObject(mesh);
    this.#lookFrom(box.getCenter(new Vector3()), 1.2 * box.getSize(new Vector3()).length());
  }

  lookAtContacts() {
    if (this.#contacts.length === 0) return this.lookAtAll();
    this.#lookFrom(this.#contactCentre(), 0.8 * this.size);
  }

  #addLights() {
    this.#scene.add(new AmbientLight(0xffffff, 1.4));
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(-0.4, -0.7, 1);
    this.#camera.add(sun);  // from the viewer: no side is in the dark
    this.#scene.add(this.#camera);
  }

  #addBodies() {
    const { images, bodies } = this.view;
    const shapes = images.map(shapeOf);
    const pieces = images.map((image) => new Pieces(image, this.colourOfLevel));
    for (const { image } of bodies) {
      const mesh = new Mesh(shapes[image], new MeshLambertMaterial());
      const patch = new Mesh(
        new BufferGeometry(),
        new MeshBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.85, depthTest: false }),
      );
      patch.renderOrder = 2;
      patch.frustumCulled = false;
      const body = new Group();  // centre and radius: vertices are for radius 1
      body.position.fromArray(images[image].centre_m);
      body.scale.setScalar(images[image].radius_m);
      body.add(mesh, patch);
      const group = new Group();
      group.add(body);
      this.#scene.add(group);
      this.#bodies.push({ group, body, mesh, patch, pieces: pieces[image] });
    }
  }

  #showContacts() {
    const points = new Float32Array(3 * this.#contacts.length);
    const colours = new Float32Array(points.length);
    const gap = new Color(style('--ink'));
    const overlap = new Color(style('--overlap'));
    this.#contacts.forEach(({ a, b, distance }, i) => {
      for (let k = 0; k < 3; ++k) points[3 * i + k] = (a.point[k] + b.point[k]) / 2;
      (distance < 0 ? overlap : gap).toArray(colours, 3 * i);
    });
    this.#contactPoints.geometry.setAttribute('position', new BufferAttribute(points, 3));
    this.#contactPoints.geometry.setAttribute('color', new BufferAttribute(colours, 3));
  }

  /// From the middle of the contacts; its length is the force's share of the largest one.
  #showForce() {
    const force = new Vector3().fromArray(this.forceAt(this.#frame));
    const largest = Math.hypot(...this.forceAt(this.strongestFrame()));
    const length = force.length();
    this.#arrow.visible = length > 0 && largest > 0 && this.#contacts.length > 0;
    if (!this.#arrow.visible) return;
    const drawn = (0.15 + 0.65 * (length / largest)) * this.size;
    this.#arrow.position.copy(this.#contactCentre());
    this.#arrow.setDirection(force.divideScalar(length));
    this.#arrow.setLength(drawn, 0.12 * this.size, 0.07 * this.size);
  }

  #contactCentre() {
    const centre = new Vector3();
    for (const { a } of this.#contacts) centre.add(new Vector3().fromArray(a.point));
    return centre.divideScalar(Math.max(this.#contacts.length, 1));
  }

  /// A narrow view has to stand back to see as much.
  #lookFrom(target, wideDistance) {
    const distance = wideDistance / Math.min(1, this.#camera.aspect);
    this.#camera.position.copy(target).addScaledVector(new Vector3(0.55, -0.9, 0.45).normalize(), distance);
    this.#camera.near = 0.01 * this.size;
    this.#camera.far = 40 * this.size;
    this.#camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.update();
    this.#draw();
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#draw();
  }

  /// The style sheet's colours, also after it changed between light and dark.
  #paint() {
    this.#scene.background = new Color(style('--paper'));
    this.#bodies.forEach(({ mesh }, index) => mesh.material.color.set(style(`--body-${index % 3}`)));
    this.#arrow.setColor(new Color(style('--series-3')));
    this.#showContacts();
    this.#draw();
  }

  #draw() {
    if (this.#pending) return;
    this.#pending = true;
    requestAnimationFrame(() => {
      this.#pending = false;
      this.renderer.render(this.#scene, this.#camera);
    });
  }
}
