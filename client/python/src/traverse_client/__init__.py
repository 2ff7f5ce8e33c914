"""Client of Traverse: short travel moves for the layers or the sliced files of 3D printers.

    from traverse_client import TravelOptimizer, island, layer

    with TravelOptimizer(["10.0.0.1:50051", "10.0.0.2:50051"]) as optimizer:
        for result in optimizer.optimize(layers, deadline_seconds=30):
            print(result.id, result.given.total_mm, "->", result.travel.total_mm)

`TravelOptimizer` and `AsyncTravelOptimizer` send layers, `GcodeGateway` and `AsyncGcodeGateway` sliced files.
Coordinates are in mm, times in seconds.
"""

from importlib.metadata import PackageNotFoundError, version

from traverse_client.aio import AsyncGcodeGateway, AsyncTravelOptimizer
from traverse_client.errors import TraverseError
from traverse_client.file_job import RewrittenFile
from traverse_client.files import GcodeGateway
from traverse_client.layers import island, layer
from traverse_client.optimizer import Strategies, TravelOptimizer
from traverse_client.wire.gcode_service_pb2 import RewriteOptions, RewriteProgress, RewriteSummary
from traverse_client.wire.options_pb2 import JobOptions, Point
from traverse_client.wire.plan_pb2 import Contour, Island, Layer, OpenPath, Plan, Visit
from traverse_client.wire.route_optimizer_service_pb2 import JobSummary, LayerResult, OptimizeBatchRequest, StrategyInfo

try:
    __version__ = version("traverse-client")
except PackageNotFoundError:  # run from a folder that is not installed
    __version__ = "unknown"

__all__ = [
    "AsyncGcodeGateway", "AsyncTravelOptimizer", "Contour", "GcodeGateway", "Island", "JobOptions", "JobSummary", "Layer",
    "LayerResult", "OpenPath", "OptimizeBatchRequest", "Plan", "Point", "RewriteOptions", "RewriteProgress",
    "RewriteSummary", "RewrittenFile", "Strategies", "StrategyInfo", "TravelOptimizer", "TraverseError", "Visit", "island",
    "layer"
]
