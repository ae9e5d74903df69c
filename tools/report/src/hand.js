// SPDX-License-Identifier: GPL-3.0-or-later
// The mouse, or a gamepad, as the hand: says where it wants the tool, and draws how it pulls.
import { BufferAttribute, BufferGeometry, Line, LineBasicMaterial, Plane, Quaternion, Raycaster, Vector2, Vector3 } from 'three';

const kTurn_rad_per_pixel = 0.008;
const kWheelOfSize = 0.0006;  // of the larger body's radius, for a pixel of the wheel
const kWheelLasts_ms = 400;
const kPushOfSize_per_s = 0.35;  // of a stick, in radii of the larger body
const kPushTurns_rad_per_s = 1.2;
const kPushAheadOfSize = 0.1;  // it does not run away from a tool that is held up
const kPushAhead_rad = 0.5;

export class Hand {
  #stage;
  #tool;
  #send;
  #pose = { position: new Vector3(), orientation: new Quaternion() };  // of the hand, as the run last said
  #wanted = null;
  #held = null;  // {point: in the tool's axes, hit, plane, turns, from: where the pointer was}
  #wheel_ms = -Infinity;
  #pending = false;
  #pushed = false;  // by a stick
  #line = new Line(new BufferGeometry(), new LineBasicMaterial({ depthTest: false, transparent: true }));

  /// send({position, orientation} | null): called once a drawn frame at most; null: it has let go.
  constructor(stage, tool, centre, send) {
    this.#stage = stage;
    this.#tool = tool;
    this.#send = send;
    this.centre = new Vector3().fromArray(centre);
    this.#line.geometry.setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
    this.#line.frustumCulled = false;
    this.#line.renderOrder = 7;
    this.#line.visible = false;
    stage.add(this.#line);
    const { host } = stage;
    // Before the camera's own controls, which are the canvas's.
    host.addEventListener('pointerdown', (event) => this.#down(event), { capture: true });
    host.addEventListener('pointermove', (event) => this.#move(event), { capture: true });
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) host.addEventListener(end, (event) => this.#up(event), { capture: true });
    host.addEventListener('wheel', (event) => this.#roll(event), { capture: true, passive: false });
    host.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /// What the run says: pose [x, y, z, qx, qy, qz, qw] of the hand.
  follow(pose) {
    this.#pose.position.fromArray(pose, 0);
    this.#pose.orientation.fromArray(pose, 3);
    this.#drawPull();
  }

  /// Goes on by so many seconds: move [right, up, away], turn [about up, about right], as seen, each -1 to 1. Zeros: it stays.
  push(move, turn, seconds) {
    if (this.#held || ![...move, ...turn].some((value) => value !== 0)) return;
    if (!this.#pushed || !this.#wanted) this.#begin();
    this.#pushed = true;
    const { quaternion } = this.#stage.camera;
    const [right, up, away] = move;
    const way = new Vector3(right, up, -away).applyQuaternion(quaternion);
    this.#wanted.position.addScaledVector(way, kPushOfSize_per_s * this.#stage.size * seconds);
    this.#turn(...turn.map((value) => (value * kPushTurns_rad_per_s * seconds) / kTurn_rad_per_pixel));
    this.#stayNear();
    this.#say();
  }

  /// A stick lets go, if it was the one that pulled.
  dropPush() {
    if (!this.#pushed) return;
    this.#pushed = false;
    if (this.#held) return;
    this.#wanted = null;
    this.#say();
  }

  #stayNear() {
    const { position, orientation } = this.#pose;
    const ahead = this.#wanted.position.clone().sub(position).clampLength(0, kPushAheadOfSize * this.#stage.size);
    this.#wanted.position.copy(position).add(ahead);
    const angle = orientation.angleTo(this.#wanted.orientation);
    if (angle > kPushAhead_rad) this.#wanted.orientation.copy(orientation.clone().rotateTowards(this.#wanted.orientation, kPushAhead_rad));
  }

  paint(colour) {
    this.#line.material.color.set(colour);
  }

  #ray(event) {
    const box = this.#stage.host.getBoundingClientRect();
    const at = new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    const caster = new Raycaster();
    caster.setFromCamera(at, this.#stage.camera);
    return caster;
  }

  #hit(event) {
    return this.#ray(event).intersectObject(this.#stage.meshOf(this.#tool), false)[0]?.point ?? null;
  }

  #forward() {
    return this.#stage.camera.getWorldDirection(new Vector3());
  }

  #begin() {
    this.#wanted = { position: this.#pose.position.clone(), orientation: this.#pose.orientation.clone() };
  }

  #down(event) {
    const hit = this.#held ? null : this.#hit(event);
    if (!hit) return;
    event.stopPropagation();
    event.preventDefault();
    this.#pushed = false;
    this.#begin();
    const drawn = this.#stage.poseOf(this.#tool);
    this.#held = {
      id: event.pointerId,
      point: hit.clone().sub(drawn.position).applyQuaternion(drawn.quaternion.clone().invert()),
      hit,
      plane: new Plane().setFromNormalAndCoplanarPoint(this.#forward(), hit),
      turns: event.shiftKey || event.button === 2,
      x: event.clientX,
      y: event.clientY,
    };
    this.#stage.host.setPointerCapture(event.pointerId);
    this.#stage.host.style.cursor = 'grabbing';
  }

  #move(event) {
    if (!this.#held) {
      if (event.buttons === 0) this.#stage.host.style.cursor = this.#hit(event) ? 'grab' : '';
      return;
    }
    if (event.pointerId !== this.#held.id) return;
    event.stopPropagation();
    if (this.#held.turns) this.#turn(event.clientX - this.#held.x, event.clientY - this.#held.y);
    else this.#shift(event);
    this.#held.x = event.clientX;
    this.#held.y = event.clientY;
    this.#say();
  }

  #shift(event) {
    const to = this.#ray(event).ray.intersectPlane(this.#held.plane, new Vector3());
    if (!to) return;
    this.#wanted.position.add(to.clone().sub(this.#held.hit));
    this.#held.hit = to;
  }

  /// About the middle of the tool, as one turns a ball in front of oneself.
  #turn(dx, dy) {
    const { position, orientation } = this.#wanted;
    const axis = (x, y) => new Vector3(x, y, 0).applyQuaternion(this.#stage.camera.quaternion);
    const turn = new Quaternion().setFromAxisAngle(axis(0, 1), kTurn_rad_per_pixel * dx);
    turn.multiply(new Quaternion().setFromAxisAngle(axis(1, 0), kTurn_rad_per_pixel * dy));
    const arm = this.centre.clone().applyQuaternion(orientation);
    position.add(arm).sub(arm.clone().applyQuaternion(turn));
    orientation.premultiply(turn).normalize();
  }

  #roll(event) {
    if (!this.#held && !this.#hit(event)) return;
    event.stopPropagation();
    event.preventDefault();
    const lines = event.deltaMode === 0 ? 1 : 16;
    const way = this.#forward().multiplyScalar(-kWheelOfSize * this.#stage.size * lines * event.deltaY);
    if (!this.#wanted || (!this.#held && performance.now() - this.#wheel_ms > kWheelLasts_ms)) this.#begin();
    this.#wheel_ms = performance.now();
    this.#wanted.position.add(way);
    if (this.#held) {
      this.#held.hit.add(way);
      this.#held.plane.translate(way);
    }
    this.#say();
  }

  /// Lets go: nothing pulls any more.
  #up(event) {
    if (!this.#held || event.pointerId !== this.#held.id) return;
    event.stopPropagation();
    this.#held = null;
    this.#stage.host.style.cursor = '';
    this.#wanted = null;
    this.#say();
  }

  #say() {
    this.#drawPull();
    if (this.#pending) return;
    this.#pending = true;
    requestAnimationFrame(() => {
      this.#pending = false;
      this.#send(this.#wanted);
    });
  }

  /// From where the tool is held to where it is wanted.
  #drawPull() {
    this.#line.visible = this.#held !== null;
    if (!this.#held) return;
    const drawn = this.#stage.poseOf(this.#tool);
    const from = this.#held.point.clone().applyQuaternion(drawn.quaternion).add(drawn.position);
    const to = this.#held.point.clone().applyQuaternion(this.#wanted.orientation).add(this.#wanted.position);
    const attribute = this.#line.geometry.getAttribute('position');
    from.toArray(attribute.array, 0);
    to.toArray(attribute.array, 3);
    attribute.needsUpdate = true;
    this.#stage.draw();
  }
}
