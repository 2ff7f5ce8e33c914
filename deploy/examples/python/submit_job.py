#!/usr/bin/env python3
"""Layers of job.pb (`traverse convert part.damat -o job.pb`) to servers: submit_job.py job.pb HOST:PORT..."""
import sys
from traverse_client import OptimizeBatchRequest, TravelOptimizer
job = OptimizeBatchRequest.FromString(open(sys.argv[1], "rb").read())
with TravelOptimizer(sys.argv[2:]) as optimizer:
    for result in optimizer.optimize(list(job.layers), deadline_seconds=30, options=job.options):
        print(f"layer {result.id}: travel {result.given.total_mm:.1f} mm -> {result.travel.total_mm:.1f} mm")
