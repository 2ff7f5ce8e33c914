"""Messages that attack, written by hand field by field (proto/traverse/v1/plan.proto)."""
import random
import struct

from http2_client import field, varint


def packed(doubles):
    return struct.pack(f"<{len(doubles)}d", *doubles)


def number(field_number, value):
    return varint(field_number << 3 | 1) + struct.pack("<d", value)


def layer(paths=20, random_points=None, corners=4):
    point = random_points or (lambda: random.uniform(0, 200))
    contours = b"".join(field(2, field(2, packed([point() for _ in range(2 * corners)]))) for _ in range(paths))
    return field(2, field(3, contours))


def options(strategy="greedy", cost=b""):
    return field(1, field(2, field(1, strategy.encode())) + (field(6, field(2, cost)) if cost else b""))


# Time costs, in which alone walls count: so much for a retraction, a lift and a crossing, and ways around walls.
def time_cost(clearance=0.4):
    return b"".join(number(n, value) for n, value in ((1, 120.0), (2, 3000.0), (3, 0.1), (4, 2.0), (6, 0.1), (7, 1.0), (9, clearance)))


def one_contour(points):
    return field(3, field(2, field(2, packed([coordinate for point in points for coordinate in point]))))


def layer_of(paths):
    contours = b"".join(field(2, field(2, packed([random.uniform(0, 200) for _ in range(8)]))) for _ in range(paths))
    return field(3, contours)


def validate_only(strategy="auto"):
    """Options of a job that is checked and not done."""
    return field(1, field(2, field(1, strategy.encode())) + b"\x68\x01")


def faulty_layers():
    """Seven bytes for each layer that is at fault, which partial answers are to say of each."""
    return field(1, field(2, field(1, b"none")) + b"\x70\x01") + field(2, field(3, field(2, field(1, b"")))) * 90_000


def empty_visits():
    """A route that is known, of two bytes a visit and of none of the layer's paths."""
    return options("auto") + field(2, field(3, field(2, field(2, packed([1.0, 2.0])))) + b"\x5a\x00" * (7 << 20))


def known_route():
    """A large layer with a route that holds, to be improved."""
    visits = b"".join(field(11, b"\x08\x00\x10" + varint(i)) for i in range(20_000))
    return options("auto") + field(2, layer_of(20_000) + visits)


def many_pairs():
    """A node of a hundred thousand paths with as many pairs."""
    count = 60_000
    paths = field(1, field(1, field(2, packed([1.0, 2.0])))) * count
    pairs = b"".join(field(2, b"\x08" + varint(i) + b"\x10" + varint(i + 1)) for i in range(count - 1))
    nodes = field(2, field(3, field(1, b"".join(varint(i + 1) for i in range(count))) + pairs))
    nodes += b"".join(field(2, b"\x08" + varint(i)) for i in range(count))
    return validate_only() + field(2, field(4, paths + nodes))


def empty_islands():
    """Two bytes for each island, up to the limit of a message."""
    return field(2, field(3, b"") * (15 << 20))


def small_contours():
    """Contours of one point, as many as the limits allow."""
    return options() + field(2, field(3, field(2, field(2, packed([1.0, 2.0]))) * 500_000))


def unknown_fields():
    """Empty texts that no version knows: two bytes each."""
    return options() + field(2, b"\x7a\x00" * (8 << 20))


def unknown_options():
    return field(1, b"\x7a\x00" * (8 << 20)) + layer(3)


def packed_children():
    """Children of a node, a byte each."""
    return options() + field(2, field(4, field(2, field(2, field(1, b"\x01" * (30 << 20))))))


def named_walls():
    """Walls that name a large contour again and again."""
    square = [(float(i), float(i % 2)) for i in range(50_000)]
    return options("greedy", time_cost()) + field(2, one_contour(square) + field(7, b"\x18\x00") * 100_000)


def exposed_paths():
    square = [(float(i), float(i % 2)) for i in range(50_000)]
    return options("greedy", time_cost()) + field(2, one_contour(square) + field(8, b"\x00" * (1 << 20)))


def retracted_paths():
    """A path that is named again and again, and moves that are no more than it."""
    square = [(float(i), float(i % 2)) for i in range(50_000)]
    return options("greedy", time_cost()) + field(
        2, one_contour(square) + field(9, b"\x00" * (1 << 20)) + field(10, b"") * 100_000)


def upright_walls():
    """A wall that goes up and down all over the plate."""
    wall = [coordinate for i in range(400_000) for coordinate in (5e-4 * i, i % 2 * 200.0)]
    return options("greedy", time_cost(0)) + field(2, layer_of(5) + field(7, field(1, packed(wall))))


def clustered_walls():
    """Walls by the hundred thousand in one place, and two far away that make the place small."""
    wall = [coordinate for i in range(100_000) for coordinate in (100 + 1e-4 * (i % 300), 100 + 1e-4 * (i % 7))]
    far = packed([-9e5, -9e5, -9e5, -8e5])
    return options("greedy", time_cost()) + field(2, layer_of(300) + field(7, field(1, packed(wall))) + field(7, field(1, far)))


def scribbled_walls():
    """A wall to and fro across the plate: each move crosses it hundreds of times, and looks for ways around it."""
    wall = [random.uniform(0, 200) for _ in range(200_000)]
    limit = field(1, field(9, b"\x08\x01"))  # a second
    return options("auto", time_cost()) + limit + field(2, layer_of(4000) + field(7, field(1, packed(wall)) + b"\x10\x01"))


def barrier(strategy):
    """Half of the paths before a node without any, and that before the others: their pairs are the square of that."""
    def body():
        half = 20_000
        paths = b"".join(field(1, field(1, field(2, packed([random.uniform(0, 200), random.uniform(0, 200)]))))
                         for _ in range(2 * half))
        children = b"".join(varint(i + 1) for i in range(2 * half + 1))
        pairs = b"".join(field(2, b"\x08" + varint(i) + b"\x10" + varint(2 * half)) for i in range(half))
        pairs += b"".join(field(2, b"\x08" + varint(2 * half) + b"\x10" + varint(half + i)) for i in range(half))
        nodes = field(2, field(3, field(1, children) + pairs))
        nodes += b"".join(field(2, b"\x08" + varint(i)) for i in range(2 * half)) + field(2, field(2, b""))
        return options(strategy) + field(2, field(4, paths + nodes))

    return body


def fixed_order():
    """Paths that may not change places: as many steps, and hardly anything to choose."""
    count = 60_000
    dot = field(1, field(1, field(2, packed([100.0, 100.0]))))
    nodes = field(2, field(2, field(1, b"".join(varint(i + 1) for i in range(count)))))
    nodes += b"".join(field(2, b"\x08" + varint(i)) for i in range(count))
    return options("exact") + field(2, field(4, dot * count + nodes))


def two_clouds(strategy):
    """Two contours of many vertices that are in no order: each of the one may go with each of the other."""
    def body():
        cloud = field(2, field(2, packed([random.uniform(0, 200) for _ in range(200_000)])))
        return options(strategy) + field(2, field(3, cloud) + field(3, cloud))

    return body


def large_layers(strategy):
    return lambda: options(strategy) + field(2, field(3, b"".join(
        field(2, field(2, packed([random.uniform(0, 200), random.uniform(0, 200)]))) for _ in range(19_000))))
