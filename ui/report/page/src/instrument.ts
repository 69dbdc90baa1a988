// The instrument in the hand: its head's silhouette turned about its axis, with a plain shank above.
import * as THREE from "three";
import type { Instrument } from "./data.ts";

const k_shank_radius_mm = 0.8;
const k_shank_mm = 16; // from the tip

/** A mesh whose tip stands at its origin and whose axis is +z. */
export function instrument_mesh(instrument: Instrument): THREE.Group {
  const group = new THREE.Group();
  const turned = (points: [number, number][], material: THREE.Material): void => {
    const lathe = new THREE.LatheGeometry(
      points.map(([z, r]) => new THREE.Vector2(r, z)),
      40,
    );
    lathe.rotateX(Math.PI / 2); // its axis y becomes z
    group.add(new THREE.Mesh(lathe, material));
  };
  const profile = instrument.profile_mm;
  const [top_mm, top_radius_mm] = profile[profile.length - 1] ?? [0, 0];
  turned(
    profile,
    new THREE.MeshStandardMaterial({
      color: 0x8f979f,
      roughness: 0.55,
      metalness: 0.35,
      side: THREE.DoubleSide,
    }),
  );
  // the profile may end with the head or run up the shank; what follows is the same for all
  const neck_mm = Math.min(top_radius_mm, 0.5) || 0.5;
  const shank: [number, number][] =
    top_mm < 6
      ? [
          [top_mm, neck_mm],
          [top_mm + 2, neck_mm],
          [top_mm + 2.8, k_shank_radius_mm],
        ]
      : [
          [top_mm, top_radius_mm],
          [top_mm + 0.5, k_shank_radius_mm],
        ];
  const end_mm = Math.max(top_mm + 4, k_shank_mm);
  turned(
    [...shank, [end_mm, k_shank_radius_mm], [end_mm, 0]],
    new THREE.MeshStandardMaterial({
      color: 0xc3c9ce,
      roughness: 0.35,
      metalness: 0.3,
      side: THREE.DoubleSide,
    }),
  );
  return group;
}

/** Stands the instrument at a tip position with its axis from tip to handle. */
export function pose_instrument(
  group: THREE.Object3D,
  tip_mm: THREE.Vector3,
  axis: THREE.Vector3,
): void {
  group.position.copy(tip_mm);
  group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis.clone().normalize());
}
