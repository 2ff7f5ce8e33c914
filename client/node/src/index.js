// Client of Traverse; index.d.ts describes what is exported.
export { TraverseError } from "./errors.js";
export { GcodeGateway } from "./gateway.js";
export { island, layer } from "./layers.js";
export { TravelOptimizer } from "./optimizer.js";
