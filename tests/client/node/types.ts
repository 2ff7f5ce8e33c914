// Compiled by package_test.py where TypeScript is at hand: the types fit what a scheduler writes.
import { GcodeGateway, TravelOptimizer, TraverseError, island, layer, type LayerResult } from "traverse-client";

export async function shortest(addresses: string[]): Promise<LayerResult[]> {
  const optimizer = new TravelOptimizer(addresses, { token: () => "secret" });
  const results: LayerResult[] = [];
  try {
    for await (const result of optimizer.optimize([layer([island({ contours: [[[0, 0], [1, 0], [1, 1]]] })])])) results.push(result);
    const known = layer([island({})], { initialRoute: results[0].visits });
    for await (const result of optimizer.optimize([known])) results.push(result);
    if (!(await optimizer.strategies()).capabilities.includes("initial_route")) return [];
  } catch (error) {
    if (!(error instanceof TraverseError) || error.code !== "UNAVAILABLE") throw error;
  }
  const made = await new GcodeGateway(addresses).rewrite("part.gcode", { options: { policy: "POLICY_FREE" } });
  console.log(made.summary.text);
  return results;
}
