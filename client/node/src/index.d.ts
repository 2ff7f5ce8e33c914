// Client of Traverse: short travel moves for the layers or the sliced files of 3D printers. Coordinates are in mm, times in s.
// Messages are those of the .proto files in this package, which have units, ranges and defaults of every field.
import type { ChannelCredentials } from "@grpc/grpc-js";

export type Points = ReadonlyArray<readonly [x: number, y: number]>;

export interface Path { id?: number; points: number[] }
export interface Island { id?: number; contours?: Path[]; rasters?: (Path & { one_way?: boolean })[] }
/** A layer of islands, or of a plan; further fields as in traverse/v1/plan.proto. */
export interface Layer { id?: number; z_mm?: number; islands?: Island[]; initial_route?: Visit[]; [field: string]: unknown }
export interface Point { x_mm: number; y_mm: number }
export interface Travel { contours_mm: number; rasters_mm: number; links_mm: number; total_mm: number }

/** One path of a route: a contour entered at `vertex`, or an open path, `reversed` or not. */
export interface Visit { island?: number; contour?: number; raster?: number; plan_path?: number; vertex?: number; reversed?: boolean }

export interface LayerResult {
  /** Position of the layer in the job, from 0. */
  index: number;
  id: number;
  start: Point;
  end: Point;
  /** Every path of the layer once, in the order to print them. */
  visits: Visit[];
  given: Travel;
  travel: Travel;
  cost_given: number;
  cost: number;
  lower_bound?: number;
  gap?: number;
  strategy: string;
  stop_reason: string;
  solve_seconds: number;
  [field: string]: unknown;
}

/** JobOptions of traverse/v1/options.proto. */
export interface JobOptions { strategy?: { name?: string; options?: Record<string, string> }; seed?: number; [field: string]: unknown }
export interface StrategyInfo { name: string; summary: string; lower_bound: boolean; options: Record<string, unknown>[] }

/** The strategies of a server, in the order of growing effort. */
export interface Strategies extends Array<StrategyInfo> {
  /** The name of the one for jobs that name none. */
  default_strategy: string;
  /** Such as 0.1.0. */
  server_version: string;
  /**
   * Words for what the server can do, as proto/VERSIONS.md has them: ask for one before you send
   * what an older server refuses with UNIMPLEMENTED.
   */
  capabilities: string[];
}

export interface ConnectionOptions {
  /** Default: plaintext. */
  credentials?: ChannelCredentials;
  /** The bearer token, or a function that returns the one of now. */
  token?: string | (() => string);
  /** What the servers' certificates say, if it is not the address. */
  serverName?: string;
}

export interface OptimizeOptions {
  /** For the whole job, with all attempts; the server answers before it with the best it has. Default: 30. */
  deadlineSeconds?: number;
  /** Instead of that of `options`; without both the server's default. */
  strategy?: string;
  options?: JobOptions;
}

/** A job or file that cannot be done. */
export class TraverseError extends Error {
  /** The name of a gRPC status, such as INVALID_ARGUMENT or UNAVAILABLE. */
  readonly code: string;
  /** What is wrong and where, in a sentence. */
  readonly details: string;
}

/** Connections to one or several servers; make one and keep it. */
export class TravelOptimizer {
  constructor(addresses: string[], options?: ConnectionOptions);
  /**
   * Yields the routes in build order, each as soon as it is there. An array goes out at once, and faults of all its layers
   * come before any work; any other iterable is read as the server takes layers. A server that goes away or is full is tried
   * again until the deadline, and layers that were answered are not asked again. Leave the loop and the server stops working.
   */
  optimize(layers: Iterable<Layer> | AsyncIterable<Layer>, options?: OptimizeOptions): AsyncGenerator<LayerResult, void, void>;
  strategies(options?: { timeoutSeconds?: number }): Promise<Strategies>;
  close(): void;
}

export interface RewriteProgress { stage: string; layers_done: number; layers: number; travel_given_mm: number; travel_mm: number }
export interface RewriteSummary { layers: number; layers_changed: number; verified: boolean; left: string[]; text: string; [field: string]: unknown }
/** RewriteOptions of traverse/v1/gcode_service.proto. */
export interface RewriteOptions { name?: string; policy?: string; report?: boolean; [field: string]: unknown }

/**
 * Connections to one or several gateways. A file is a job of one of them: a call that is lost goes on where it was, and a
 * gateway that has gone, or has forgotten the job, gets the file again.
 */
export class GcodeGateway {
  constructor(addresses: string[], options?: ConnectionOptions);
  /** The same print with less travel. `file`: a path, or the bytes. Rejects with TraverseError if it cannot be rewritten. */
  rewrite(file: string | Uint8Array, options?: {
    deadlineSeconds?: number; options?: RewriteOptions; onProgress?: (progress: RewriteProgress) => void;
    /** As of CreateJobOptions in traverse/v1/gcode_service.proto; default: one of its own. */
    idempotencyKey?: string;
  }): Promise<{ data: Buffer; report: string; summary: RewriteSummary }>;
  close(): void;
}

/** A connected region: closed contours (the closing segment is implied) and open paths. */
export function island(paths: { id?: number; contours?: Points[]; rasters?: Points[] }): Island;
/**
 * `initialRoute`: a legal route that is known, every path once, such as the `visits` of an earlier result. The search begins
 * with it, and the result costs no more. Servers whose capabilities lack "initial_route" refuse it.
 */
export function layer(islands: Island[], options?: { id?: number; zMm?: number; initialRoute?: Visit[] }): Layer;
