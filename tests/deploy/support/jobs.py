"""Jobs for the tests of deploy/: plates of square islands, as JSON of the API's OptimizeBatchRequest."""

import json
import math


def plate(layers=4, islands=6, options=None, vertices=8):
    """A request of round islands on a grid, each with a raster, in an order that is worth improving."""
    side = math.ceil(math.sqrt(islands))
    # Every other column first: the given order travels far.
    order = sorted(range(islands), key=lambda i: (i % side % 2, i))

    def island(place):
        x, y = 20.0 * (place % side), 20.0 * (place // side)
        ring = [coordinate for k in range(vertices) for coordinate in (
            x + 5 * math.cos(2 * math.pi * k / vertices), y + 5 * math.sin(2 * math.pi * k / vertices))]
        return {"contours": [{"points": ring}], "rasters": [{"points": [x - 3, y - 3, x + 3, y + 3]}]}

    return {"options": options or {},
            "layers": [{"id": index + 1, "islands": [island(place) for place in order]} for index in range(layers)]}


def write(path, **arguments):
    """Writes plate(**arguments) to a file and returns the file's path."""
    path.write_text(json.dumps(plate(**arguments)))
    return path
