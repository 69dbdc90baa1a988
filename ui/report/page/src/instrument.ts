// The instrument in the hand: its head's silhouette turned about its axis, with a plain shank above.
import * as THREE from "three";
import type { Instrument } from "./data.ts";

const k_shank_radius_mm = 0.8;
const k_shank_mm = 9;

/** A mesh whose tip stands at its origin and whose axis is +z. */
export function instrument_mesh(instrument: Instrument): THREE.Group {
  const group = new THREE.Group();
  const turned = (points: [number, number][], material: THREE.Material): void => {
    const lathe = new THREE.LatheGeometry(points.map(([z, r]) => new THREE.Vector2(r, z)), 40);
    lathe.rotateX(Math.PI / 2); // its axis y becomes z
    group.add(new THREE.Mesh(lathe, material));
  };
  const profile = instrument.profile_mm;
  const [top_mm, top_radius_mm] = profile[profile.length - 1] ?? [0, 0];
  turned(profile, new THREE.MeshStandardMaterial({ color: 0x8f979f, roughness: 0.55, metalness: 0.35, side: THREE.DoubleSide }));
  const neck: [number, number][] = [
    [top_mm, top_radius_mm],
    [top_mm + 0.05, Math.min(top_radius_mm, 0.5) || 0.5],
    [top_mm + 2, 0.5],
    [top_mm + 2.8, k_shank_radius_mm],
    [top_mm + k_shank_mm, k_shank_radius_mm],
    [top_mm + k_shank_mm, 0],
  ];
  turned(neck, new THREE.MeshStandardMaterial({ color: 0xc3c9ce, roughness: 0.35, metalness: 0.3, side: THREE.DoubleSide }));
  return group;
}

/** Stands the instrument at a tip position with its axis from tip to handle. */
export function pose_instrument(group: THREE.Object3D, tip_mm: THREE.Vector3, axis: THREE.Vector3): void {
  group.position.copy(tip_mm);
  group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis.clone().normalize());
}
