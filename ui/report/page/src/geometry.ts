// What the 3D view hands to the graphics card: surfaces, and fields as textures in three dimensions.
import * as THREE from "three";
import type { Vec3 } from "./data.ts";
import type { Block } from "./tooth_field.ts";
import type { Surface } from "./tooth_surface.ts";

/** Geometry whose arrays grow with what is put into it. */
export class Growing {
  readonly geometry = new THREE.BufferGeometry();
  private capacity = { vertices: 0, indices: 0 };

  put(surface: Surface): void {
    const vertices = surface.cubes.length;
    const indices = surface.triangles.length;
    if (vertices > this.capacity.vertices || indices > this.capacity.indices) {
      this.geometry.dispose();
      this.capacity = { vertices: Math.ceil(vertices * 1.3), indices: Math.ceil(indices * 1.3) };
      const { vertices: v, indices: i } = this.capacity;
      this.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * v), 3));
      this.geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(3 * v), 3));
      this.geometry.setAttribute(
        "tissue_colour",
        new THREE.BufferAttribute(new Uint8Array(3 * v), 3, true),
      );
      this.geometry.setAttribute("marks", new THREE.BufferAttribute(new Float32Array(2 * v), 2));
      this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(i), 1));
    }
    const fill = (attribute: THREE.BufferAttribute, values: ArrayLike<number>): void => {
      attribute.array.set(values);
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, values.length);
      attribute.needsUpdate = true;
    };
    const of = (name: string): THREE.BufferAttribute =>
      this.geometry.getAttribute(name) as THREE.BufferAttribute;
    fill(of("position"), surface.positions);
    fill(of("normal"), surface.normals);
    fill(of("tissue_colour"), surface.colours);
    fill(of("marks"), surface.marks);
    fill(this.geometry.index!, surface.triangles);
    this.geometry.setDrawRange(0, indices);
  }
}

export function geometry_of(surface: Surface): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(surface.positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(surface.normals, 3));
  geometry.setAttribute("tissue_colour", new THREE.BufferAttribute(surface.colours, 3, true));
  geometry.setAttribute("marks", new THREE.BufferAttribute(surface.marks, 2));
  geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
  return geometry;
}

export function volume_texture(
  data: Uint8Array,
  size: Vec3,
  filter: THREE.MagnificationTextureFilter,
): THREE.Data3DTexture {
  const texture = new THREE.Data3DTexture(data as Uint8Array<ArrayBuffer>, ...size);
  texture.format = THREE.RedFormat;
  texture.type = THREE.UnsignedByteType;
  texture.minFilter = texture.magFilter = filter;
  texture.wrapS = texture.wrapT = texture.wrapR = THREE.ClampToEdgeWrapping;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}

export function bytes_of(values: Float32Array, whole: Vec3, block: Block, into: Uint8Array): void {
  let i = 0;
  for (let z = block.low[2]; z < block.low[2] + block.size[2]; ++z)
    for (let y = block.low[1]; y < block.low[1] + block.size[1]; ++y) {
      const from = (z * whole[1] + y) * whole[0] + block.low[0];
      for (let x = 0; x < block.size[0]; ++x) into[i++] = values[from + x] * 255 + 0.5;
    }
}
