# Makes nave.obj, a nave of seven bays with aisles, pointed arcades, lancet windows to the south (+x), a
# rose window in the east (+y) and a pointed barrel vault, and nave_panes.obj, what fills its windows.
# Metres, z up; fronts look inward.
import math

BAYS, BAY = 7, 4.0
LENGTH = BAYS * BAY
HALF, AISLE = 5.5, 3.0  # outer walls at x = -HALF, HALF; arcades at x = -AISLE, AISLE
SPRING, APEX = 8.0, 12.5  # of the vault
PIER = 0.45  # half the width of a pier

vertices, faces = {}, {}  # corner -> index; group -> polygons


def polygon(group, corners):
    indices = []
    for corner in corners:
        corner = tuple(round(c, 6) for c in corner)
        index = vertices.setdefault(corner, len(vertices))
        if not indices or indices[-1] != index:
            indices.append(index)
    faces.setdefault(group, []).append(indices)


def pointed(half_width, spring, steps=5):
    """Right half of a pointed arch, from its foot at (half_width, spring) to the apex at (0, ...).

    Each side is an arc about the opposite foot: the equilateral arch.
    """
    radius = 2 * half_width
    return [(-half_width + radius * math.cos(a), spring + radius * math.sin(a))
            for a in (math.pi / 3 * i / steps for i in range(steps + 1))]


def bay_wall(group, place, y, opening, top, half):
    """The two halves of a bay's wall around an opening, whose right half `opening` ends at its apex."""
    bottom = opening[0][1]
    for side in (1, -1):
        outline = [(side * half, 0.0), (side * half, top), (0.0, top)]
        outline += [(side * s, z) for s, z in reversed(opening)]
        outline += [(0.0, bottom), (0.0, 0.0)] if bottom > 0 else []
        corners = [place(y + s, z) for s, z in outline]
        polygon(group, corners if side < 0 else corners[::-1])


def south(y, z):
    return (HALF, y, z)


# The vault: two arcs of which each has its centre on the other side of the nave, made to meet at APEX.
def vault_profile(steps=8):
    rise = APEX - SPRING
    centre = (HALF * HALF - rise * rise) / (2 * HALF)  # on the springing line [m]
    radius = HALF - centre
    last = math.atan2(rise, -centre)
    return [(centre + radius * math.cos(last * i / steps), SPRING + radius * math.sin(last * i / steps))
            for i in range(steps + 1)]


profile = vault_profile()
for side in (1, -1):
    for (x0, z0), (x1, z1) in zip(profile, profile[1:]):
        corners = [(side * x0, 0, z0), (side * x0, LENGTH, z0), (side * x1, LENGTH, z1), (side * x1, 0, z1)]
        polygon("vault", corners[::-side])

polygon("floor", [(-HALF, 0, 0), (HALF, 0, 0), (HALF, LENGTH, 0), (-HALF, LENGTH, 0)])
polygon("walls", [(-HALF, 0, 0), (-HALF, LENGTH, 0), (-HALF, LENGTH, SPRING), (-HALF, 0, SPRING)])

lancet = [(0.7, 2.2)] + pointed(0.7, 5.6)
arch = [(BAY / 2 - PIER, 0.0)] + pointed(BAY / 2 - PIER, 3.6)
for bay in range(BAYS):
    y = (bay + 0.5) * BAY
    bay_wall("walls", south, y, lancet, SPRING, BAY / 2)
    left = [(-s, z) for s, z in reversed(lancet)][1:]
    polygon("south", [south(y + s, z) for s, z in lancet + left])
    for x in (-AISLE, AISLE):
        # A sheet of stone 0.5 m thick would be two of these; one shows the same shafts.
        bay_wall("arcade", lambda s, z, x=x: (x, s, z), y, arch, 7.4, BAY / 2)

# The ends: the west plain, the east around a rose.
centre, radius, spokes = 7.6, 1.7, 16
circle = [(radius * math.sin(math.pi * i / (spokes / 2)), centre + radius * math.cos(math.pi * i / (spokes / 2)))
          for i in range(spokes // 2 + 1)]  # the right half, from the top down
for y in (0.0, LENGTH):
    for side in (1, -1):
        outline = [(0.0, 0.0), (side * HALF, 0.0)] + [(side * x, z) for x, z in profile]
        if y == LENGTH:
            outline += [(side * x, z) for x, z in circle]
        corners = [(x, y, z) for x, z in outline]
        polygon("ends", corners[::side * (1 if y == LENGTH else -1)])
left = [(-x, z) for x, z in reversed(circle)][1:-1]
polygon("rose", [(x, LENGTH, z) for x, z in circle + left][::-1])


def write(name, title, groups):
    with open(name, "w") as out:
        print("# " + title + " Made by nave.py.", file=out)
        used = sorted({i for group in groups for face in faces[group] for i in face})
        number = {i: n + 1 for n, i in enumerate(used)}
        corners = list(vertices)
        for i in used:
            print("v %g %g %g" % corners[i], file=out)
        for group in groups:
            print("g " + group, file=out)
            for face in faces[group]:
                print("f " + " ".join(str(number[i]) for i in face), file=out)


write("nave.obj", "A nave.", ["floor", "walls", "arcade", "vault", "ends"])
write("nave_panes.obj", "The panes of its windows.", ["south", "rose"])
