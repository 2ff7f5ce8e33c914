import grpc from "@grpc/grpc-js";

export class TraverseError extends Error {
  constructor(code, details, cause) {
    super(`${grpc.status[code]}: ${details}`, { cause });
    this.name = "TraverseError";
    this.code = grpc.status[code];
    this.details = details;
  }
}
