// The 3D view: the tooth with its colours, the section where it is cut away, the target's outline, the instrument, the marked place. It draws only
// when something changed.
import * as THREE from "three";
import type { Instrument, ReportData, Vec3 } from "./data.ts";
import { bytes_of, geometry_of, Growing, volume_texture } from "./geometry.ts";
import { instrument_mesh, pose_instrument } from "./instrument.ts";
import type { Sample } from "./motion.ts";
import { k_views, Orbit } from "./orbit.ts";
import { type Clip, in_sight, outward_at, probe, type Reading } from "./probe.ts";
import type { ToothField } from "./tooth_field.ts";
import {
  section_material,
  shared_uniforms,
  type SharedUniforms,
  tooth_material,
} from "./tooth_material.ts";
import { heat_at, type Surface, target_surface, ToothSurface } from "./tooth_surface.ts";
import { Surroundings } from "./surroundings.ts";
import { thinned } from "./thinned_surface.ts";
import {
  drawn_by_processor,
  marker_of,
  outline_material,
  spheres,
  tissue_kind,
} from "./view_parts.ts";

export interface ViewOptions {
  edges: readonly number[];
  whole: number;
}

const k_back = 0xf4f5f3;
// Drawn by the processor, a picture that changes has fewer pixels and triangles, and all of them when it has rested for a while.
const k_changing_share = 0.35;
const k_rest_ms = 500;

export class ToothView {
  readonly orbit: Orbit;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly surface: ToothSurface;
  private readonly growing = new Growing();
  private readonly shared: SharedUniforms;
  private readonly surroundings: Surroundings;
  private readonly density: THREE.Data3DTexture;
  private readonly still: {
    surface: Surface;
    geometry: THREE.BufferGeometry;
    thinned: THREE.BufferGeometry;
    mesh: THREE.Mesh | null;
  };
  private readonly duration_s: number;
  private deeper_mm = 0;
  private readonly section: THREE.Mesh;
  private readonly moving_bytes: Uint8Array;
  private readonly moving_texture: THREE.Data3DTexture;
  private readonly target = new THREE.Group();
  private readonly marker: THREE.Group;
  private instruments: { from_s: number; group: THREE.Group }[] = [];
  private clip: Clip | null = null;
  private section_version = -1;
  private with_instrument = true;
  private pending = false;
  private readonly by_processor: boolean;
  private pixel_share = 1;
  private rest_timer: ReturnType<typeof setTimeout> | undefined;
  private sampled: Sample | null = null;
  private sampled_s = 0;
  readonly centre: THREE.Vector3;
  readonly radius: number;
  /** Called before each picture. */
  on_draw: (() => void) | null = null;
  private twin: ToothView | null = null;

  /** Throws when WebGL is not to be had. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly field: ToothField,
    data: ReportData,
    options: ViewOptions,
  ) {
    this.by_processor = drawn_by_processor();
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      antialias: !this.by_processor,
      preserveDrawingBuffer: true,
    });
    this.renderer.setClearColor(k_back);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.duration_s = data.duration_s ?? 0;
    const { cell_mm, origin_mm, size } = field;
    const place = (object: THREE.Object3D, low: Vec3): void => {
      object.position.set(...(origin_mm.map((o, a) => o + low[a] * cell_mm) as Vec3));
      object.scale.setScalar(cell_mm);
    };

    this.shared = shared_uniforms(options.edges, options.whole);
    this.surface = new ToothSurface(field, data);
    this.surroundings = new Surroundings(field);
    const density = (this.density = volume_texture(
      this.surroundings.bytes,
      this.surroundings.size,
      THREE.LinearFilter,
    ));
    const coarse_mm = this.surroundings.cell_mm;
    const material = tooth_material(this.shared, {
      density: { value: density },
      density_low: { value: new THREE.Vector3(...this.surroundings.low_mm) },
      density_size: {
        value: new THREE.Vector3(...this.surroundings.size).multiplyScalar(coarse_mm),
      },
      back_colour: { value: new THREE.Vector3(0.55, 0.5, 0.45) },
    });
    const surface = this.surface.still();
    const still = geometry_of(surface);
    const fewer = new THREE.BufferGeometry();
    if (this.by_processor)
      fewer
        .copy(still)
        .setIndex(new THREE.BufferAttribute(thinned(surface, field.size, field.moving_edges()), 1));
    this.still = { surface, geometry: still, thinned: fewer, mesh: null };
    for (const geometry of [still, this.growing.geometry, geometry_of(this.surface.open_pulp())]) {
      const mesh = new THREE.Mesh(geometry, material);
      this.still.mesh ??= mesh;
      mesh.frustumCulled = false;
      place(mesh, [0, 0, 0]);
      this.scene.add(mesh);
    }
    const { whole, home } = spheres(field);
    this.centre = whole.centre;
    this.radius = whole.radius;

    // the section
    const moving = field.moving ?? { low: [0, 0, 0] as Vec3, size: [1, 1, 1] as Vec3 };
    const whole_bytes = new Uint8Array(field.values.length);
    bytes_of(field.untouched, size, { low: [0, 0, 0], size }, whole_bytes);
    this.moving_bytes = new Uint8Array(moving.size[0] * moving.size[1] * moving.size[2]);
    this.moving_texture = volume_texture(this.moving_bytes, moving.size, THREE.LinearFilter);
    const distance_bytes = Uint8Array.from(field.distance, (d) => d + 128);
    const palette = Array.from({ length: 16 }, (_, i) => {
      const colour = new THREE.Color(data.tissues[i]?.colour ?? "#cccccc").convertLinearToSRGB();
      return new THREE.Vector3(colour.r, colour.g, colour.b);
    });
    this.section = new THREE.Mesh(
      new THREE.PlaneGeometry(2 * this.radius, 2 * this.radius),
      section_material(this.shared, {
        still_share: { value: volume_texture(whole_bytes, size, THREE.LinearFilter) },
        moving_share: { value: this.moving_texture },
        tissue: { value: volume_texture(field.tissue, size, THREE.NearestFilter) },
        distance_box: { value: volume_texture(distance_bytes, field.box.size, THREE.LinearFilter) },
        low: { value: new THREE.Vector3(...origin_mm) },
        cells: { value: new THREE.Vector3(...size) },
        moving_low: { value: new THREE.Vector3(...moving.low) },
        moving_cells: {
          value: new THREE.Vector3(...(field.moving ? moving.size : ([0, 0, 0] as Vec3))),
        },
        box_low: { value: new THREE.Vector3(...field.box.low) },
        box_cells: { value: new THREE.Vector3(...field.box.size) },
        cell: { value: cell_mm },
        palette: { value: palette },
        kind: { value: Int32Array.from({ length: 16 }, (_, i) => tissue_kind(data.tissues[i])) },
        with_target: { value: true },
      }),
    );
    this.section.visible = false;
    this.scene.add(this.section);

    this.target.visible = false;
    const outline = target_surface(field);
    const shape = new THREE.BufferGeometry();
    shape.setAttribute("position", new THREE.BufferAttribute(outline.positions.slice(), 3));
    shape.setAttribute("normal", new THREE.BufferAttribute(outline.normals.slice(), 3));
    shape.setIndex(new THREE.BufferAttribute(outline.triangles.slice(), 1));
    for (const [opacity, through] of [
      [0.42, false],
      [0.16, true],
    ] as [number, boolean][]) {
      const mesh = new THREE.Mesh(shape, outline_material(this.shared, opacity, through));
      mesh.renderOrder = 2;
      mesh.frustumCulled = false;
      place(mesh, field.box.low);
      this.target.add(mesh);
    }
    this.scene.add(this.target);

    this.marker = marker_of();
    this.scene.add(this.marker);
    this.set_instruments(data.instruments ?? []);
    const sun = new THREE.DirectionalLight(0xffffff, 2.2);
    sun.position.set(-0.5, 0.7, 0.8);
    this.orbit = new Orbit(canvas, home, whole, () => this.redraw());
    this.orbit.camera.add(sun);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x999999, 1.6), this.orbit.camera);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
    this.show(0, null);
  }

  /** The tooth and the instrument at a time. */
  show(t_s: number, sample: Sample | null): void {
    this.sampled = sample;
    this.sampled_s = t_s;
    this.redraw();
  }

  /** Another view that shows what this one is told to show, from where this one is seen, and the other way round. */
  join(twin: ToothView): void {
    this.twin = twin;
    this.orbit.join(twin.orbit);
  }

  set_colouring(by_deviation: boolean): void {
    this.twin?.set_colouring(by_deviation);
    this.shared.by_deviation.value = by_deviation;
    this.redraw();
  }

  set_target(visible: boolean): void {
    this.twin?.set_target(visible);
    this.target.visible = visible;
    this.redraw();
  }

  set_instrument(visible: boolean): void {
    this.twin?.set_instrument(visible);
    this.with_instrument = visible;
    this.redraw();
  }

  /** Cuts the tooth away beyond a plane; null shows it whole. */
  set_clip(clip: Clip | null): void {
    this.twin?.set_clip(clip);
    this.clip = clip;
    const n = clip ? new THREE.Vector3(...clip.normal) : new THREE.Vector3();
    (this.shared.clip.value as THREE.Vector4).set(n.x, n.y, n.z, clip ? clip.offset_mm : 1);
    this.section.visible = clip !== null;
    if (clip) {
      this.section.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), n);
      this.section.position
        .copy(this.centre)
        .addScaledVector(n, clip.offset_mm - n.dot(this.centre) - 1e-3);
      this.section.updateMatrixWorld();
    }
    this.redraw();
  }

  /** Marks a place and, when it is hidden, turns until it is seen; null takes the mark away. */
  mark(place_mm: Vec3 | null): void {
    this.marker.visible = place_mm !== null;
    if (place_mm) {
      this.marker.position.set(...place_mm);
      this.update_tooth();
      this.face(place_mm);
    }
    this.redraw();
  }

  /** What lies under a point of the canvas, in CSS pixels from its upper left corner. */
  read(x: number, y: number): Reading | null {
    const ray = new THREE.Raycaster();
    ray.setFromCamera(
      new THREE.Vector2(
        (2 * x) / this.canvas.clientWidth - 1,
        1 - (2 * y) / this.canvas.clientHeight,
      ),
      this.orbit.camera,
    );
    return probe(
      this.field,
      ray.ray.origin.toArray() as Vec3,
      ray.ray.direction.toArray() as Vec3,
      this.clip,
    );
  }

  /** For a class: shows the share that deviated by more than `deeper_mm`. */
  set_heat_depth(deeper_mm: number): void {
    this.deeper_mm = deeper_mm;
    const marks = new THREE.BufferAttribute(
      this.surface.heat_marks(this.still.surface, deeper_mm),
      2,
    );
    for (const geometry of [this.still.geometry, this.still.thinned])
      geometry.setAttribute("marks", marks);
    this.redraw();
  }

  /** For a class: the share of it, per cent, that deviated at a place of the surface; null where nothing is known. */
  heat_at(place_mm: Vec3): number | null {
    return heat_at(this.field, place_mm, outward_at(this.field, place_mm), this.deeper_mm);
  }

  redraw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.draw();
    });
  }

  /** `rests`: nothing has changed for a while. */
  draw(rests = false): void {
    if (this.by_processor) this.adapt_pixels(rests);
    this.update_tooth();
    this.update_section();
    this.update_instrument();
    const size = this.orbit.camera.position.distanceTo(this.marker.position) * 0.014;
    this.marker.scale.setScalar(size);
    this.marker.quaternion.copy(this.orbit.camera.quaternion);
    this.on_draw?.();
    this.renderer.render(this.scene, this.orbit.camera);
  }

  private adapt_pixels(rests: boolean): void {
    const share = rests ? 1 : k_changing_share;
    if (share !== this.pixel_share)
      this.renderer.setPixelRatio(
        Math.min(window.devicePixelRatio, 2) * (this.pixel_share = share),
      );
    if (this.still.mesh)
      this.still.mesh.geometry = rests ? this.still.geometry : this.still.thinned;
    this.canvas.dataset.rests = String(rests);
    clearTimeout(this.rest_timer);
    if (rests) return;
    // from when this picture stands
    requestAnimationFrame(() => {
      clearTimeout(this.rest_timer);
      this.rest_timer = setTimeout(
        () => requestAnimationFrame(() => this.pending || this.draw(true)),
        k_rest_ms,
      );
    });
  }

  private update_tooth(): void {
    if (!this.field.set_time(this.sampled_s)) return;
    const surface = this.surface.moving();
    if (surface) this.growing.put(surface);
    this.surroundings.update();
    this.density.needsUpdate = true;
  }

  private update_section(): void {
    if (!this.section.visible || this.section_version === this.field.version || !this.field.moving)
      return;
    this.section_version = this.field.version;
    bytes_of(this.field.values, this.field.size, this.field.moving, this.moving_bytes);
    this.moving_texture.needsUpdate = true;
  }

  private update_instrument(): void {
    let current: THREE.Group | null = null;
    for (const { from_s, group } of this.instruments) {
      if (from_s <= this.sampled_s || current === null) current = group;
      group.visible = false;
    }
    // at the end stands the result, with nothing before it
    if (!current || !this.sampled || !this.with_instrument || this.sampled_s >= this.duration_s)
      return;
    current.visible = true;
    pose_instrument(
      current,
      new THREE.Vector3(...this.sampled.tip_mm),
      new THREE.Vector3(...this.sampled.axis),
    );
  }

  private set_instruments(list: Instrument[]): void {
    this.instruments = [...list]
      .sort((a, b) => a.from_s - b.from_s)
      .map((i) => ({ from_s: i.from_s, group: instrument_mesh(i) }));
    for (const { group } of this.instruments) this.scene.add(group);
  }

  private face(place_mm: Vec3): void {
    const towards = this.orbit.camera.position
      .clone()
      .sub(new THREE.Vector3(...place_mm))
      .normalize();
    if (in_sight(this.field, place_mm, towards.toArray() as Vec3)) return;
    for (const elevation_deg of [45, 65, 90, 20, 0, -20])
      for (let i = 0; i < 8; ++i) {
        const azimuth_deg = k_views.oblique.azimuth_deg + 45 * (i % 2 ? (i + 1) / 2 : -i / 2);
        const [a, e] = [(azimuth_deg * Math.PI) / 180, (elevation_deg * Math.PI) / 180];
        if (
          !in_sight(this.field, place_mm, [
            Math.cos(e) * Math.cos(a),
            Math.cos(e) * Math.sin(a),
            Math.sin(e),
          ])
        )
          continue;
        this.orbit.look({ azimuth_deg, elevation_deg });
        return;
      }
  }

  private resize(): void {
    const width = Math.max(this.canvas.parentElement!.clientWidth, 1);
    const height = Math.max(this.canvas.parentElement!.clientHeight, 1);
    this.renderer.setSize(width, height, false);
    this.orbit.resize(width, height);
    this.draw();
  }
}
