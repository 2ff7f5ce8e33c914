"""Makes layers from points."""

from typing import Iterable, Sequence, Tuple

from traverse_client.wire import plan_pb2

Points = Sequence[Tuple[float, float]]


def island(contours: Iterable[Points] = (), rasters: Iterable[Points] = (), id: int = 0) -> plan_pb2.Island:
    """A connected region: closed contours (the closing segment is implied) and open paths, as points (x, y) in mm.

    Paths get their positions from 0 as ids.
    """
    made = plan_pb2.Island(id=id)
    for paths, add in ((contours, made.contours.add), (rasters, made.rasters.add)):
        for number, points in enumerate(paths):
            add(id=number, points=[value for point in points for value in point])
    return made


def layer(islands: Iterable[plan_pb2.Island], id: int = 0, z_mm: float = 0.0,
          initial_route: Iterable[plan_pb2.Visit] = ()) -> plan_pb2.Layer:
    """A layer of islands at the height `z_mm`; `id` is echoed in its result.

    initial_route: a legal route that is known, every path once, such as the `visits` of an earlier result. The search begins
    with it, and the result costs no more. Servers whose `strategies().capabilities` lack "initial_route" refuse it.
    """
    return plan_pb2.Layer(id=id, z_mm=z_mm, islands=islands, initial_route=initial_route)
