"""What a scanner makes of a surface: any pose, noise, a mesh of its own, and only what it sees. Written apart from the program that reads its scans:
numpy, and nothing of Cavum. Lengths in mm.
"""
import struct

import numpy as np


def read_stl(path):
    """Corners (n, 3) and triangles (m, 3) of a binary STL, equal corners joined."""
    with open(path, "rb") as file:
        file.seek(80)
        count = struct.unpack("<I", file.read(4))[0]
        data = np.frombuffer(file.read(count * 50), dtype=np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]))
    corners = data["v"].reshape(-1, 3)
    order = np.lexsort(corners.T)
    new = np.ones(len(order), dtype=bool)
    new[1:] = (corners[order[1:]] != corners[order[:-1]]).any(axis=1)
    index = np.empty(len(order), dtype=np.int64)
    index[order] = np.cumsum(new) - 1
    return corners[order[new]].astype(float), index.reshape(-1, 3)


def write_stl(path, corners, triangles):
    data = np.zeros(len(triangles), dtype=np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]))
    data["v"] = corners[triangles]
    with open(path, "wb") as file:
        file.write(b"scan".ljust(80) + struct.pack("<I", len(triangles)) + data.tobytes())


def write_text_stl(path, corners, triangles):
    with open(path, "w") as file:
        file.write("solid scan\n")
        for t in corners[triangles]:
            file.write("facet normal 0 0 0\nouter loop\n" + "".join("vertex %.9g %.9g %.9g\n" % tuple(v) for v in t) + "endloop\nendfacet\n")
        file.write("endsolid scan\n")


def write_obj(path, corners, triangles):
    with open(path, "w") as file:
        file.writelines("v %.9g %.9g %.9g\n" % tuple(v) for v in corners)
        file.writelines("f %d %d %d\n" % tuple(t + 1) for t in triangles)


def random_rotation(random):
    """Evenly over all rotations (QR of a normal matrix)."""
    q, r = np.linalg.qr(random.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else q[:, [1, 0, 2]]


def posed(corners, random, reach_mm=50.0):
    """In any rotation, moved by up to `reach_mm`."""
    way = random.normal(size=3)
    return corners @ random_rotation(random).T + way / np.linalg.norm(way) * reach_mm * random.uniform()


def noisy(corners, random, sigma_mm=0.02):
    return corners + random.normal(scale=sigma_mm, size=corners.shape)


def without_unused(corners, triangles):
    used, index = np.unique(triangles, return_inverse=True)
    return corners[used], index.reshape(-1, 3)


def crown_only(corners, triangles, above_mm, tilt=(0.0, 0.0)):
    """Cut along a plane through z = above_mm at the middle: whole triangles, so that the rim is ragged."""
    keep = corners[:, 2] - tilt[0] * corners[:, 0] - tilt[1] * corners[:, 1] > above_mm
    return without_unused(corners, triangles[keep[triangles].all(axis=1)])


def closed_base(corners, triangles):
    """A fan over the longest rim, as scanners' programs close a model."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    code = edges[:, 0].astype(np.int64) * len(corners) + edges[:, 1]
    back = edges[:, 1].astype(np.int64) * len(corners) + edges[:, 0]
    rim = edges[~np.isin(code, back)]
    follows = {a: b for a, b in rim}
    loops = []
    while follows:
        first = next(iter(follows))
        loop, at = [], first
        while at in follows:
            loop.append(at)
            at = follows.pop(at)
        loops.append(loop)
    loop = max(loops, key=len)
    middle = corners[loop].mean(axis=0)
    fan = [(len(corners), b, a) for a, b in zip(loop, loop[1:] + loop[:1])]
    return np.vstack([corners, middle]), np.vstack([triangles, fan])


def clustered(corners, triangles, cell_mm, mean):
    """A mesh of its own, about `cell_mm` wide: all corners of a cell become one (Rossignac and Borrel 1993), their mean or the one nearest to it."""
    cells = np.floor((corners - corners.min(axis=0)) / cell_mm).astype(np.int64)
    _, index = np.unique(cells @ np.array([1, 1 << 20, 1 << 40]), return_inverse=True)
    index = index.reshape(-1)
    count = np.bincount(index)
    joined = np.stack([np.bincount(index, corners[:, k]) / count for k in range(3)], axis=1)
    if not mean:
        away = ((corners - joined[index]) ** 2).sum(axis=1)
        order = np.lexsort((away, index))
        joined = corners[order[np.searchsorted(index[order], np.arange(len(count)))]]
    t = index[triangles]
    t = t[(t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])]
    # of triangles over the same corners those that face each other cancel, so that what was closed stays so
    order = np.sort(t, axis=1)
    odd = ((t[:, 0] > t[:, 1]).astype(int) + (t[:, 1] > t[:, 2]) + (t[:, 0] > t[:, 2])) % 2
    each, index = np.unique(order, axis=0, return_inverse=True)
    sides = np.bincount(index.reshape(-1), 1 - 2 * odd).astype(int)
    return joined, np.repeat(np.where((sides > 0)[:, None], each, each[:, [0, 2, 1]]), np.abs(sides), axis=0)


def smoothed(corners, triangles, rounds):
    """Taubin 1995: a step inwards and a longer one back, so that it does not shrink."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    edges = np.concatenate([edges, edges[:, ::-1]])
    degree = np.maximum(np.bincount(edges[:, 0], minlength=len(corners)), 1)[:, None]
    for _ in range(rounds):
        for step in (0.5, -0.53):
            mean = np.stack([np.bincount(edges[:, 0], corners[edges[:, 1], k], minlength=len(corners)) for k in range(3)], axis=1) / degree
            corners = corners + step * (mean - corners)
    return corners


def mirrored(corners, triangles):
    return corners * [-1, 1, 1], triangles[:, [0, 2, 1]]


KINDS = ("fine", "crown", "base", "smoothed", "raw")


def scan(corners, triangles, random, kind, sigma_mm=0.02, neck_mm=-3.5):
    """A scan of a surface in its tooth's frame (z occlusal): corners and triangles in the scanner's.

    raw       the mesh as it is, noise on every corner
    fine      a scanner's own mesh, 0.1 mm wide, noise on every corner
    crown     the same, only what lies above the neck: open below
    base      the same, closed by a flat base
    smoothed  a noisy mesh of 0.1 mm, smoothed, and decimated to 0.2 mm
    """
    turn = random_rotation(random)
    if kind != "raw":
        corners, triangles = clustered(corners @ turn.T, triangles, 0.1, mean=False)  # its cells lie as the scanner does, not as the tooth
        corners = corners @ turn
    if kind in ("crown", "base"):
        corners, triangles = crown_only(corners, triangles, neck_mm + random.uniform(-0.5, 0.5), random.uniform(-0.1, 0.1, size=2))
    corners = noisy(corners, random, sigma_mm)
    if kind == "base":
        corners, triangles = closed_base(corners, triangles)
    if kind == "smoothed":
        corners = smoothed(corners, triangles, 3)
        corners, triangles = clustered(corners @ turn.T, triangles, 0.2, mean=True)
        corners = corners @ turn
        corners, triangles = without_unused(corners, triangles)
    return posed(corners, random), triangles
