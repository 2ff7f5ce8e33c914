#!/usr/bin/python3
"""Sends a job to Traverse and shows its progress.

    ./generate.sh
    traverse convert part.damat -o job.json        (or .gcode; job.pb is smaller)
    ./submit_job.py job.json --server=10.0.0.1:50051,10.0.0.2:50051 --deadline=30 --routes=routes.jsonl

Exit codes: 0 done; 1 the job is at fault; 2 usage; 3 no server did it in time, or none lets us in.
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "generated"))

import grpc
from google.protobuf import json_format, message

from traverse.v1 import route_optimizer_service_pb2 as api
from traverse_client import RETRIED, JobFailed, TraverseClient

OURS = (*RETRIED, grpc.StatusCode.DEADLINE_EXCEEDED, grpc.StatusCode.UNAUTHENTICATED,
        grpc.StatusCode.PERMISSION_DENIED)


def arguments():
    parser = argparse.ArgumentParser(description="Sends a job to Traverse and shows its progress.")
    parser.add_argument("job", type=pathlib.Path, help="an OptimizeBatchRequest as .json or .pb")
    parser.add_argument("--server", default="127.0.0.1:50051", help="HOST:PORT[,HOST:PORT...]")
    parser.add_argument("--deadline", type=float, default=30, help="seconds for the whole job")
    parser.add_argument("--strategy", help="instead of the job's own")
    parser.add_argument("--ca", type=pathlib.Path, help="PEM file of the servers' authority: use TLS")
    parser.add_argument("--server_name", help="name in the servers' certificate, if it is not the address")
    parser.add_argument("--certificate", type=pathlib.Path, help="PEM file to show to servers that want one; with --key")
    parser.add_argument("--key", type=pathlib.Path, help="PEM file of its private key")
    parser.add_argument("--token_file", type=pathlib.Path, help="file with the bearer token alone")
    parser.add_argument("--routes", type=pathlib.Path, help="write one line of JSON per layer")
    args = parser.parse_args()
    if bool(args.certificate) != bool(args.key):
        parser.error("--certificate and --key go together")
    if not args.ca and (args.certificate or args.token_file):
        parser.error("certificates and tokens need TLS: give --ca")
    if args.ca and "," in args.server and not args.server_name:
        parser.error("several addresses have one certificate: give --server_name")
    return args


def credentials(args):
    """What the flags say, or None for plaintext."""
    if not args.ca:
        return None
    files = [path.read_bytes() if path else None for path in (args.ca, args.key, args.certificate)]
    encrypted = grpc.ssl_channel_credentials(*files)
    if not args.token_file:
        return encrypted
    token = grpc.access_token_call_credentials(args.token_file.read_text().strip())
    return grpc.composite_channel_credentials(encrypted, token)


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
    try:
        client = TraverseClient(args.server.split(","), credentials(args), args.server_name)
    except (OSError, ValueError) as error:
        print(f"submit_job.py: {error}", file=sys.stderr)
        return 2
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
