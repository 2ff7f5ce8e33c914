// Sends a job of one layer to the server at argv[1], with the token in argv[2] if there is one, and
// prints the number of visits of its route.

#include <cstdio>
#include <string>
#include <vector>

#include "client/api/channel.h"
#include "client/api/optimizer_client.h"

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto channel = traverse::ConnectTo({argv[1]});
  if (!channel.ok()) return 3;
  traverse::OptimizerClient client(*channel, argc > 2 ? argv[2] : "");
  traverse::v1::JobOptions options;
  options.mutable_strategy()->set_name("greedy");
  std::vector<traverse::v1::Layer> layers(1);
  traverse::v1::Island& island = *layers[0].add_islands();
  for (const double x : {1.0, 2.0, 3.0}) {
    traverse::v1::OpenPath& raster = *island.add_rasters();
    for (const double c : {x, 0.0, x, 9.0}) raster.add_points(c);
  }
  const auto result = client.Optimize(options, layers, {.deadline = absl::Seconds(20)});
  if (!result.ok()) {
    std::fprintf(stderr, "%s\n", result.status().ToString().c_str());
    return 1;
  }
  std::printf("%d\n", result->layers[0].visits_size());
  return 0;
}
