// Looking at the tooth from all around: azimuth and elevation about a centre, by mouse, touch and keyboard. The camera's up is part of the
// angles, so that straight from above is a view like any other. The wheel zooms only while the view has the focus: a page must scroll.
import * as THREE from "three";

export interface Sphere {
  centre: THREE.Vector3;
  radius: number;
}

export interface Pose {
  azimuth_deg: number;
  elevation_deg: number;
}

/** Where the eye stands for each named view; +x mesial, +y buccal, +z occlusal. */
export const k_views: { [name: string]: Pose } = {
  oblique: { azimuth_deg: 62, elevation_deg: 42 },
  occlusal: { azimuth_deg: -90, elevation_deg: 90 },
  mesial: { azimuth_deg: 0, elevation_deg: 0 },
  distal: { azimuth_deg: 180, elevation_deg: 0 },
  buccal: { azimuth_deg: 90, elevation_deg: 0 },
  lingual: { azimuth_deg: -90, elevation_deg: 0 },
};

const k_turn_key_deg = 6;
const k_turn_deg_per_px = 0.4;
const k_zoom_key = 1.15;

export class Orbit {
  readonly camera = new THREE.PerspectiveCamera(24, 1, 0.5, 400);
  private pose: Pose = { ...k_views.oblique };
  private readonly centre = new THREE.Vector3();
  private distance = 30;
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private twin: Orbit | null = null;

  /** `home`: what the view shows first; `whole`: all there is. `changed` is called after every move. */
  constructor(
    private readonly element: HTMLElement,
    private readonly home: Sphere,
    private readonly whole: Sphere,
    private readonly changed: () => void,
  ) {
    this.reset();
    element.addEventListener("pointerdown", (e) => {
      element.setPointerCapture(e.pointerId);
      this.pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    });
    const end = (e: PointerEvent): void => {
      this.pointers.delete(e.pointerId);
    };
    element.addEventListener("pointerup", end);
    element.addEventListener("pointercancel", end);
    element.addEventListener("pointermove", (e) => this.drag(e));
    element.addEventListener("contextmenu", (e) => e.preventDefault());
    element.addEventListener(
      "wheel",
      (e) => {
        if (document.activeElement !== element && !e.ctrlKey) return;
        e.preventDefault();
        this.zoom(Math.exp(-e.deltaY * 0.0012));
      },
      { passive: false },
    );
    element.addEventListener("keydown", (e) => this.key(e));
  }

  get dragging(): boolean {
    return this.pointers.size > 0;
  }

  /** Both look from the same place from now on. */
  join(twin: Orbit): void {
    this.twin = twin;
    twin.twin = this;
    this.place();
  }

  look(pose: Pose): void {
    this.pose = { ...pose };
    this.place();
  }

  reset(): void {
    this.centre.copy(this.home.centre);
    this.pose = { ...k_views.oblique };
    this.distance = this.fitting();
    this.place();
  }

  /** All of it, from where the eye stands. */
  show_whole(): void {
    this.centre.copy(this.whole.centre);
    this.distance = (this.fitting() * this.whole.radius) / this.home.radius;
    this.place();
  }

  resize(width: number, height: number): void {
    const fitted = this.distance / this.fitting();
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.distance = fitted * this.fitting();
    this.place();
  }

  zoom(by: number): void {
    const fit = this.fitting();
    this.distance = Math.min(Math.max(this.distance / by, fit * 0.12), fit * 4);
    this.place();
  }

  turn(azimuth_deg: number, elevation_deg: number): void {
    this.pose.azimuth_deg += azimuth_deg;
    this.pose.elevation_deg = Math.min(Math.max(this.pose.elevation_deg + elevation_deg, -90), 90);
    this.place();
  }

  private fitting(): number {
    const half = (this.camera.fov * Math.PI) / 360;
    return (
      this.home.radius / Math.sin(Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect)))
    );
  }

  private drag(e: PointerEvent): void {
    const before = this.pointers.get(e.pointerId);
    if (!before) return;
    const now = { x: e.clientX, y: e.clientY };
    const others = [...this.pointers.entries()].filter(([id]) => id !== e.pointerId);
    if (others.length === 0 && !e.shiftKey && (e.buttons & 2) === 0) {
      this.turn((before.x - now.x) * k_turn_deg_per_px, (now.y - before.y) * k_turn_deg_per_px);
    } else if (others.length === 0) {
      this.pan(now.x - before.x, now.y - before.y);
    } else {
      const other = others[0][1];
      const span = (p: { x: number; y: number }): number =>
        Math.max(Math.hypot(p.x - other.x, p.y - other.y), 10);
      this.zoom(span(now) / span(before));
      this.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    }
    this.pointers.set(e.pointerId, now);
  }

  private pan(dx: number, dy: number): void {
    const mm_per_px =
      (2 * this.distance * Math.tan((this.camera.fov * Math.PI) / 360)) /
      Math.max(this.element.clientHeight, 1);
    const right = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const up = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    this.centre.addScaledVector(right, -dx * mm_per_px).addScaledVector(up, dy * mm_per_px);
    this.place();
  }

  private key(e: KeyboardEvent): void {
    if (e.ctrlKey || e.altKey || e.metaKey) return;
    const d = k_turn_key_deg;
    const turns: { [key: string]: [number, number] } = {
      ArrowLeft: [-d, 0],
      ArrowRight: [d, 0],
      ArrowUp: [0, d],
      ArrowDown: [0, -d],
    };
    if (turns[e.key]) this.turn(...turns[e.key]);
    else if (e.key === "+" || e.key === "=") this.zoom(k_zoom_key);
    else if (e.key === "-" || e.key === "_") this.zoom(1 / k_zoom_key);
    else if (e.key === "Home") this.reset();
    else return;
    e.preventDefault();
  }

  private place(): void {
    this.stand();
    this.twin?.follow(this);
  }

  /** As far away as the other one, where the views are of one shape. */
  private follow(other: Orbit): void {
    this.pose = { ...other.pose };
    this.centre.copy(other.centre);
    this.distance = (other.distance / other.fitting()) * this.fitting();
    this.stand();
  }

  private stand(): void {
    const a = (this.pose.azimuth_deg * Math.PI) / 180;
    const e = (this.pose.elevation_deg * Math.PI) / 180;
    this.camera.position
      .set(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e))
      .multiplyScalar(this.distance)
      .add(this.centre);
    this.camera.up.set(-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e));
    this.camera.lookAt(this.centre);
    const reach = 3 * this.whole.radius; // the instrument stands out of the tooth
    this.camera.near = Math.max(this.distance - reach, 0.1);
    this.camera.far = this.distance + reach;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.changed();
  }
}
