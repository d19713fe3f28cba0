"""Meshes made to break a remesher, from a seed: a shape, damaged in one to four ways, in one of the formats.

The same seed always gives the same file.
"""

import math
import random
import struct

MOST_FACES = 1500


# Shapes: lists of points (x, y, z) and of faces (tuples of point numbers).

def grid(rng, columns, rows, place, wrap_u=False, wrap_v=False):
    points = [place(u / columns, v / rows)
              for v in range(rows + (not wrap_v)) for u in range(columns + (not wrap_u))]
    width = columns + (not wrap_u)
    height = rows + (not wrap_v)
    faces = []
    for v in range(rows):
        for u in range(columns):
            a = v * width + u
            b = v * width + (u + 1) % width
            c = (v + 1) % height * width + (u + 1) % width
            d = (v + 1) % height * width + u
            faces += [(a, b, c, d)] if rng.random() < 0.3 else [(a, b, c), (a, c, d)]
    return points, faces


def plane(rng):
    size = rng.choice([0, 0.1, 1])
    phase = rng.random()
    return grid(rng, rng.randint(1, 20), rng.randint(1, 20),
                lambda u, v: (u, v, size * math.sin(7 * u + phase) * v))


def torus(rng):
    tube = rng.choice([0.01, 0.3, 0.9, 1.5])  # the last crosses itself
    return grid(rng, rng.randint(3, 25), rng.randint(3, 25), lambda u, v: (
        (1 + tube * math.cos(math.tau * v)) * math.cos(math.tau * u),
        (1 + tube * math.cos(math.tau * v)) * math.sin(math.tau * u),
        tube * math.sin(math.tau * v)), True, True)


def tube(rng):
    length = rng.choice([1e-3, 1, 100])
    return grid(rng, rng.randint(3, 25), rng.randint(1, 12), lambda u, v: (
        math.cos(math.tau * u), math.sin(math.tau * u), length * v), True)


def moebius(rng):
    points, faces = grid(rng, rng.randint(5, 30), 2, lambda u, v: (
        (1 + 0.4 * (v - 0.5) * math.cos(math.pi * u)) * math.cos(math.tau * u),
        (1 + 0.4 * (v - 0.5) * math.cos(math.pi * u)) * math.sin(math.tau * u),
        0.4 * (v - 0.5) * math.sin(math.pi * u)))
    width = len(points) // 3
    end = {v * width + width - 1: (2 - v) * width for v in range(3)}
    return points, [tuple(end.get(i, i) for i in face) for face in faces]


def ball(rng):
    points, faces = grid(rng, rng.randint(3, 20), rng.randint(2, 16), lambda u, v: (
        math.sin(math.pi * v) * math.cos(math.tau * u),
        math.sin(math.pi * v) * math.sin(math.tau * u), math.cos(math.pi * v)), True)
    return points, faces  # rows of equal points at the poles


def box(rng):
    size = [rng.choice([1, 1, 1e-4, 1e3]) for _ in range(3)]
    points = [(size[0] * (i & 1), size[1] * (i >> 1 & 1), size[2] * (i >> 2)) for i in range(8)]
    return points, [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2),
                    (1, 3, 7, 5)]


def fan(rng):
    n = rng.randint(3, 200)
    height = rng.choice([0, 1, 1e4])
    points = [(0, 0, height)] + [(math.cos(math.tau * i / n), math.sin(math.tau * i / n), 0)
                                 for i in range(n)]
    faces = [(0, 1 + i, 1 + (i + 1) % n) for i in range(n)]
    if rng.random() < 0.5:
        faces.append(tuple(range(n, 0, -1)))  # a base with very many corners
    return points, faces


def soup(rng):
    n = rng.randint(3, 60)
    points = [(rng.random(), rng.random(), rng.random()) for _ in range(n)]
    return points, [tuple(rng.sample(range(n), 3)) for _ in range(rng.randint(1, 120))]


def specks(rng):
    points, faces = [], []
    for _ in range(rng.randint(2, 120)):
        centre = [rng.uniform(-1, 1) for _ in range(3)]
        size = 10 ** rng.uniform(-6, -0.5)
        first = len(points)
        points += [tuple(c + size * rng.gauss(0, 1) for c in centre) for _ in range(4)]
        faces += [tuple(first + i for i in f) for f in
                  ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))[:rng.randint(1, 4)]]
    return points, faces


SHAPES = [plane, torus, tube, moebius, ball, box, fan, soup, specks]


# Damages: each changes points and faces in place.

def some(rng, items):
    return rng.sample(range(len(items)), max(1, int(len(items) * rng.choice([0, 0.02, 0.3]))))


def noise(rng, points, faces):
    size = 10 ** rng.uniform(-8, -0.5)
    points[:] = [tuple(x + rng.gauss(0, size) for x in p) for p in points]


def squash(rng, points, faces):
    factors = [10 ** rng.uniform(-7, 2) if rng.random() < 0.5 else 1 for _ in range(3)]
    points[:] = [tuple(x * f for x, f in zip(p, factors)) for p in points]


def delete_faces(rng, points, faces):
    gone = set(some(rng, faces))
    faces[:] = [f for i, f in enumerate(faces) if i not in gone] or faces[:1]


def turn_faces(rng, points, faces):
    for i in some(rng, faces):
        faces[i] = faces[i][::-1]


def repeat_faces(rng, points, faces):
    faces += [faces[i] for i in some(rng, faces)]


def copy_sheet(rng, points, faces):
    shift = rng.choice([0, 1e-12, 1e-3])
    first = len(points)
    points += [(x, y, z + shift) for x, y, z in points]
    faces += [tuple(i + first for i in f) for f in faces]


def join_points(rng, points, faces):
    for i in some(rng, points):
        j = rng.randrange(len(points))
        faces[:] = [tuple(j if k == i else k for k in f) for f in faces]


def same_place(rng, points, faces):
    for i in some(rng, points):
        points[i] = points[rng.randrange(len(points))]


def split_all(rng, points, faces):
    separate = [p for f in faces for p in (points[i] for i in f)]
    first, new = 0, []
    for f in faces:
        new.append(tuple(range(first, first + len(f))))
        first += len(f)
    points[:], faces[:] = separate, new


def spikes(rng, points, faces):
    for i in some(rng, points):
        points[i] = tuple(x * 10 ** rng.uniform(0, 6) for x in points[i])


def flatten(rng, points, faces):
    axis = rng.randrange(3)
    points[:] = [tuple(0 if i == axis else x for i, x in enumerate(p)) for p in points]


def snap(rng, points, faces):
    step = 10 ** rng.uniform(-3, -0.3)
    points[:] = [tuple(round(x / step) * step if math.isfinite(x / step) else x for x in p)
                 for p in points]


def far_away(rng, points, faces):
    shift = [rng.choice([0, 1, -1]) * 10 ** rng.uniform(0, 9) for _ in range(3)]
    points[:] = [tuple(x + s for x, s in zip(p, shift)) for p in points]


def rescale(rng, points, faces):
    factor = 10 ** rng.uniform(-30, 30)
    points[:] = [tuple(x * factor for x in p) for p in points]


def not_numbers(rng, points, faces):
    for i in some(rng, points):
        points[i] = rng.choice([(math.nan, 0, 0), (0, math.inf, 0), (1e308, -1e308, 1e308)])


def fins(rng, points, faces):
    for i in some(rng, faces):
        points.append(tuple(rng.gauss(0, 1) for _ in range(3)))
        faces.append((faces[i][0], faces[i][1], len(points) - 1))


def wild_faces(rng, points, faces):
    for i in some(rng, faces):
        faces[i] = tuple(rng.choice([rng.randrange(len(points)), len(points) + 5, -1])
                         for _ in range(rng.randint(1, 9)))


def t_junctions(rng, points, faces):
    for i in some(rng, faces):
        f = faces[i]
        points.append(tuple((a + b) / 2 for a, b in zip(points[f[0]], points[f[1]])))
        faces[i] = f[:1] + (len(points) - 1,) + f[1:]


DAMAGES = [noise, squash, delete_faces, turn_faces, repeat_faces, copy_sheet, join_points,
           same_place, split_all, spikes, flatten, snap, far_away, rescale, not_numbers, fins,
           wild_faces, t_junctions]


# Files.

def write_obj(rng, points, faces):
    end = rng.choice(["\n", "\r\n", "\r"])
    relative = rng.random() < 0.2
    lines = ["v " + " ".join(map(repr, map(float, p))) for p in points]
    lines += ["f " + " ".join(str(i - len(points) if relative and 0 <= i < len(points) else i + 1)
                              for i in f) for f in faces]
    return end.join(lines).encode()


def write_off(rng, points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(map(repr, map(float, p))) for p in points]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    return "\n".join(lines).encode()


def single(x):
    try:
        return struct.unpack("<f", struct.pack("<f", x))[0]
    except OverflowError:
        return math.inf


def write_ply(rng, points, faces):
    ending = rng.choice(["little", "big"])
    mark = "<" if ending == "little" else ">"
    kind, code = rng.choice([("float", "f"), ("double", "d")])
    header = (f"ply\nformat binary_{ending}_endian 1.0\nelement vertex {len(points)}\n"
              + "".join(f"property {kind} {axis}\n" for axis in "xyz")
              + f"element face {len(faces)}\nproperty list uint int vertex_indices\nend_header\n")
    body = [struct.pack(mark + "3" + code, *(map(single, p) if code == "f" else p))
            for p in points]
    body += [struct.pack(f"{mark}I{len(f)}i", len(f), *f) for f in faces]
    return header.encode() + b"".join(body)


def write_stl(rng, points, faces):
    triangles = [(f[0], f[i], f[i + 1]) for f in faces for i in range(1, len(f) - 1)
                 if all(0 <= k < len(points) for k in f)]
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(single(x) for i in t for x in points[i]), 0)
                    for t in triangles)
    return b"solid".ljust(80) + struct.pack("<I", len(triangles)) + body


WRITERS = {".obj": write_obj, ".off": write_off, ".ply": write_ply, ".stl": write_stl}


def corrupt(rng, data):
    """Changes, drops or cuts off bytes."""
    data = bytearray(data)
    for _ in range(rng.randint(1, 8)):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data[:rng.randrange(len(data))] if rng.random() < 0.3 else data)


def write_mesh(seed, folder):
    """Writes the mesh of a seed into the folder. Returns its path."""
    rng = random.Random(seed)
    shape = rng.choice(SHAPES)
    points, faces = shape(rng)
    chosen = [rng.choice(DAMAGES) for _ in range(rng.randint(1, 4))]
    chosen.sort(key=lambda damage: damage is wild_faces)  # the others need corners that are there
    for damage in chosen:
        if 0 < len(faces) <= MOST_FACES:
            damage(rng, points, faces)
    extension = rng.choice(list(WRITERS))
    data = WRITERS[extension](rng, points, faces)
    if rng.random() < 0.1:
        data = corrupt(rng, data)
    name = "-".join([f"{seed:06d}", shape.__name__, *(damage.__name__ for damage in chosen)])
    path = folder / (name + extension)
    path.write_bytes(data)
    return path
