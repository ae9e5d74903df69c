// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in a 3D view: bodies, the pieces that are in contact, contacts, and the force.
// Lengths are metres from the tool's first position. Drawn when something changes, not all the time.
import {
  AmbientLight, ArrowHelper, Box3, BufferAttribute, BufferGeometry, CanvasTexture, Color, DirectionalLight, Group, LineBasicMaterial,
  LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Points, PointsMaterial, Scene, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { counts, floats } from './data.js';
import { Overlay } from './overlay.js';
import { number } from './units.js';

const kFelt = 0.01;  // of the largest: what carries less is not marked
const kShown_N = 1e-3;
// Transparent though they are not: what is see-through is drawn after all that is not.
const kOnTop = { depthTest: false, transparent: true };

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function shapeOf(image) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(floats(image.points), 3));
  geometry.setIndex(new BufferAttribute(counts(image.faces), 1));
  geometry.computeVertexNormals();
  return geometry;
}

/// A disc, for points.
function disc() {
  const picture = document.createElement('canvas');
  picture.width = picture.height = 64;
  const ink = picture.getContext('2d');
  ink.fillStyle = '#fff';
  ink.arc(32, 32, 30, 0, 2 * Math.PI);
  ink.fill();
  return new CanvasTexture(picture);
}

function dots(size_px, map, more) {
  const material = new PointsMaterial({ size: size_px, sizeAttenuation: false, map, alphaTest: 0.5, ...kOnTop, ...more });
  return new Points(new BufferGeometry(), material);
}

/// Triples into an attribute, in the memory that it has where they fit.
function refill(geometry, name, values) {
  const attribute = geometry.getAttribute(name);
  if (attribute && attribute.array.length >= values.length) {
    attribute.array.set(values);
    attribute.needsUpdate = true;
  } else {
    geometry.setAttribute(name, new BufferAttribute(values, 3));
  }
  geometry.setDrawRange(0, values.length / 3);
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
  #contactPoints;
  #carrying;  // a rim about those that carry the force
  #normals = new LineSegments(new BufferGeometry(), new LineBasicMaterial(kOnTop));
  #arrow = new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), 1, 0x888888);
  #pending = false;
  #contacts = [];
  #patched = false;
  #overlay;
  #force_N = 0;

  /// Throws where the browser has no WebGL.
  constructor(host, view) {
    this.host = host;
    this.view = view;
    this.size = Math.max(...view.bodies.map((body) => view.images[body.image].radius_m));
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    host.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute('aria-label', 'Both bodies and their contacts in 3D');
    this.renderer.domElement.setAttribute('role', 'img');
    this.#addLights();
    this.#addBodies();
    const round = disc();
    this.#carrying = dots(14, round);
    this.#contactPoints = dots(8, round, { vertexColors: true });
    [this.#normals, this.#carrying, this.#contactPoints].forEach((part, i) => {
      part.renderOrder = 3 + i;
      part.frustumCulled = false;
    });
    this.#scene.add(this.#normals, this.#carrying, this.#contactPoints, this.#arrow);
    for (const part of [this.#arrow.line, this.#arrow.cone]) {
      Object.assign(part.material, kOnTop);
      part.renderOrder = 6;
    }
    this.#camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.#camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.#draw());
    this.#overlay = new Overlay(host, view.bodies);
    for (const type of ['pointermove', 'pointerdown', 'pointerleave']) host.addEventListener(type, (event) => this.#point(event));
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

  /// pose: [x, y, z, qx, qy, qz, qw], from `at` on.
  place(index, pose, at = 0) {
    const { group } = this.#bodies[index];
    group.position.fromArray(pose, at);
    group.quaternion.fromArray(pose, at + 3);
  }

  /// contacts: [{point, distance, force_N, normal?, a?, b?}]; a and b say on which pieces they lie, force_N what each carries.
  showContacts(contacts) {
    this.#contacts = contacts;
    const sides = contacts.flatMap((c) => [c.a, c.b]).filter((side) => side);
    if (sides.length > 0 || this.#patched) {
      this.#bodies.forEach((body, index) => body.pieces.fill(body.patch.geometry, sides.filter((side) => side.body === index)));
    }
    this.#patched = sides.length > 0;
    this.#drawContacts();
  }

  /// From the middle of the contacts. most_N: the force of the longest arrow.
  showForce(force, most_N) {
    const direction = new Vector3().fromArray(force);
    this.#force_N = direction.length();
    this.#arrow.visible = this.#force_N > kShown_N && this.#contacts.length > 0;
    if (!this.#arrow.visible) return;
    const share = this.#force_N / Math.max(most_N, this.#force_N);
    this.#arrow.position.copy(this.#contactCentre());
    this.#arrow.setDirection(direction.normalize());
    this.#arrow.setLength((0.12 + 0.38 * share) * this.size, 0.09 * this.size, 0.05 * this.size);
  }

  /// Once everything is in its place.
  draw() {
    this.#draw();
  }

  /// What is pointed at while no button is down; a finger points where it comes down.
  #point(event) {
    const busy = event.type === 'pointerleave' || (event.type === 'pointermove' && event.buttons !== 0);
    this.#overlay.point(busy ? null : event);
    this.#draw();
  }

  /// Of the force's arrow, in pixels of the host; null where there is none in sight.
  #arrowTip() {
    if (!this.#arrow.visible) return null;
    const tip = new Vector3(0, this.#arrow.cone.position.y, 0).applyQuaternion(this.#arrow.quaternion);
    return this.pixelOf(tip.add(this.#arrow.position));
  }

  /// Of a point in the scene; null where it is behind the viewer.
  pixelOf(point) {
    const { x, y, z } = point.clone().project(this.#camera);
    if (z > 1) return null;
    return { x: ((x + 1) / 2) * this.host.clientWidth, y: ((1 - y) / 2) * this.host.clientHeight };
  }

  get camera() {
    return this.#camera;
  }

  /// Where a body is drawn: {position, quaternion}.
  poseOf(index) {
    return this.#bodies[index].group;
  }

  /// The drawn surface of a body, for what is pointed at.
  meshOf(index) {
    return this.#bodies[index].mesh;
  }

  /// More to draw.
  add(...objects) {
    this.#scene.add(...objects);
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
    this.#lookFrom(this.#contactCentre(), 1.2 * this.size);
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

  #drawContacts() {
    const points = new Float32Array(3 * this.#contacts.length);
    const colours = new Float32Array(points.length);
    const gap = new Color(style('--ink'));
    const overlap = new Color(style('--overlap'));
    const normals = [];
    const carrying = [];
    const most_N = this.#contacts.reduce((most, c) => Math.max(most, c.force_N), 0);
    this.#contacts.forEach(({ point, distance, normal, force_N }, i) => {
      points.set(point, 3 * i);
      (distance < 0 ? overlap : gap).toArray(colours, 3 * i);
      if (force_N > kFelt * most_N) carrying.push(...point);
      if (normal) normals.push(...point, ...point.map((x, k) => x + 0.12 * this.size * normal[k]));
    });
    refill(this.#contactPoints.geometry, 'position', points);
    refill(this.#contactPoints.geometry, 'color', colours);
    refill(this.#carrying.geometry, 'position', new Float32Array(carrying));
    refill(this.#normals.geometry, 'position', new Float32Array(normals));
  }

  #contactCentre() {
    const centre = new Vector3();
    for (const { point } of this.#contacts) centre.add(new Vector3().fromArray(point));
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

  /// Where the view turns about.
  #metresPerPixel() {
    const away = this.#camera.position.distanceTo(this.controls.target);
    return (2 * away * Math.tan((Math.PI / 360) * this.#camera.fov)) / Math.max(this.host.clientHeight, 1);
  }

  #drawOverlay() {
    this.#overlay.draw(this.#camera, {
      force: { text: `${number(this.#force_N, 2)} N`, at: this.#arrowTip() },
      contacts: this.#contacts,
      pixelOf: (i) => this.pixelOf(new Vector3().fromArray(this.#contacts[i].point)),
      metresPerPixel: this.#metresPerPixel(),
    });
  }

  /// The style sheet's colours, also after it changed between light and dark.
  #paint() {
    this.#scene.background = new Color(style('--paper'));
    this.#bodies.forEach(({ mesh }, index) => mesh.material.color.set(style(`--body-${index % 3}`)));
    this.#arrow.setColor(new Color(style('--series-3')));
    this.#carrying.material.color.set(style('--series-3'));
    this.#normals.material.color.set(style('--quiet'));
    this.#drawContacts();
    this.#draw();
  }

  #draw() {
    if (this.#pending) return;
    this.#pending = true;
    requestAnimationFrame(() => {
      this.#pending = false;
      this.renderer.render(this.#scene, this.#camera);
      this.#drawOverlay();
    });
  }
}
