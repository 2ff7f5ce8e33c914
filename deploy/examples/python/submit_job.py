#!/usr/bin/python3
"""Sends a job to Traverse and shows its progress.

    ./generate.sh
    traverse convert part.damat -o job.json        (or .gcode; job.pb is smaller)
    ./submit_job.py job.json --server=10.0.0.1:50051,10.0.0.2:50051 --deadline=30 --routes=routes.jsonl

Exit codes: 0 done; 1 the job is at fault; 2 usage; 3 no server did it in time.
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "generated"))

import grpc
from google.protobuf import json_format, message

from traverse.v1 import route_optimizer_service_pb2 as api
from traverse_client import RETRIED, JobFailed, TraverseClient

OURS = (*RETRIED, grpc.StatusCode.DEADLINE_EXCEEDED)


def arguments():
    parser = argparse.ArgumentParser(description="Sends a job to Traverse and shows its progress.")
    parser.add_argument("job", type=pathlib.Path, help="an OptimizeBatchRequest as .json or .pb")
    parser.add_argument("--server", default="127.0.0.1:50051", help="HOST:PORT[,HOST:PORT...]")
    parser.add_argument("--deadline", type=float, default=30, help="seconds for the whole job")
    parser.add_argument("--strategy", help="instead of the job's own")
    parser.add_argument("--ca", type=pathlib.Path, help="PEM file of the servers' authority: use TLS")
    parser.add_argument("--routes", type=pathlib.Path, help="write one line of JSON per layer")
    return parser.parse_args()


def read_job(path):
    if path.suffix == ".json":
        return json_format.Parse(path.read_text(), api.OptimizeBatchRequest())
    return api.OptimizeBatchRequest.FromString(path.read_bytes())


def main():
    args = arguments()
    try:
        job = read_job(args.job)
    except (OSError, ValueError, json_format.ParseError, message.DecodeError) as error:
        print(f"{args.job}: {error}", file=sys.stderr)
        return 1
    if args.strategy:
        job.options.strategy.name = args.strategy
    credentials = grpc.ssl_channel_credentials(args.ca.read_bytes()) if args.ca else None
    client = TraverseClient(args.server.split(","), credentials)
    routes = args.routes.open("w") if args.routes else None
    given = travel = 0.0
    try:
        for result in client.optimize(job, args.deadline):
            given += result.given.total_mm + result.cleaning_given_mm
            travel += result.travel.total_mm + result.cleaning_mm
            show_progress(result.index + 1, len(job.layers), given, travel)
            if routes:
                routes.write(json_format.MessageToJson(result, indent=None, preserving_proto_field_name=True) + "\n")
    except JobFailed as failure:
        print(f"{args.job}: {failure}", file=sys.stderr)
        return 3 if failure.code in OURS else 1
    finally:
        client.close()
        if routes:
            routes.close()
    print(f"{len(job.layers)} layers, travel {given:.1f} mm -> {travel:.1f} mm")
    return 0


def show_progress(done, layers, given, travel):
    if sys.stdout.isatty():
        saved = 100 * (1 - travel / given) if given > 0 else 0
        print(f"\r{done}/{layers} layers, {saved:.1f} % of the travel saved ", end="\n" if done == layers else "")


if __name__ == "__main__":
    sys.exit(main())
