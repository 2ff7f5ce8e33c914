#include "client/damat/writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "client/damat/reader.h"

namespace traverse {
namespace {

// A seeded job of islands with awkward coordinates.
InputJob RandomJob(uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1e6, 1e6);
  std::uniform_int_distribution<int> few(0, 4);
  InputJob job;
  for (int f = few(random); f > 0; --f) {
    v1::Layer& layer = job.layers.emplace_back();
    layer.set_id(static_cast<uint64_t>(100 - f));
    for (int i = few(random); i > 0; --i) {
      v1::Island& island = *layer.add_islands();
      island.set_id(static_cast<uint64_t>(i));
      const int contours = few(random);
      for (int c = contours; c > 0; --c) {
        v1::Contour& contour = *island.add_contours();
        contour.set_id(static_cast<uint64_t>(c));
        if (c == contours) {  // around all others
          for (const double v : {-1e6, -1e6, 1e6, -1e6, 1e6, 1e6, -1e6, 1e6}) contour.add_points(v);
          continue;
        }
        for (int p = few(random); p >= 0; --p) {
          contour.add_points(coordinate(random));
          contour.add_points(coordinate(random));
        }
        // Now and then a closing vertex that is meant.
        if (few(random) == 0) {
          contour.add_points(contour.points(0));
          contour.add_points(contour.points(1));
        }
      }
      for (int r = few(random); r > 0; --r) {
        v1::OpenPath& raster = *island.add_rasters();
        raster.set_id(static_cast<uint64_t>(r));
        for (int k = 0; k < 4; ++k) raster.add_points(coordinate(random));
      }
    }
  }
  return job;
}

TEST(DamatWriter, ReadingGivesBackWhatWasWritten) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    const InputJob job = RandomJob(seed);

    const absl::StatusOr<std::string> text = WriteDamat(job);
    ASSERT_TRUE(text.ok()) << text.status() << " seed " << seed;
    const absl::StatusOr<InputJob> again = ReadDamat(*text, "again.damat");

    ASSERT_TRUE(again.ok()) << again.status() << " seed " << seed;
    ASSERT_EQ(again->layers.size(), job.layers.size()) << "seed " << seed;
    for (size_t i = 0; i < job.layers.size(); ++i) {
      EXPECT_EQ(again->layers[i].DebugString(), job.layers[i].DebugString()) << "seed " << seed;
    }
  }
}

TEST(DamatWriter, KeepsEnvelopeOrStatesTheBoundingBox) {
  const InputJob given = *ReadDamat("M,50,60\nnF,1\nF1,1\nI1,1,0\nC1,X7,Y8.5\n", "a");
  InputJob computed = given;
  computed.envelope.reset();

  EXPECT_EQ(*WriteDamat(given), "// INICIO DO ARQUIVO\nM,50,60\nnF,1\nF1,1\nI1,1,0\nC1,X7,Y8.5\n");
  EXPECT_EQ(*WriteDamat(computed),
            "// INICIO DO ARQUIVO\nM,7,8.5\nnF,1\nF1,1\nI1,1,0\nC1,X7,Y8.5\n");
}

TEST(DamatWriter, KeepsTheThicknessOfEqualLayers) {
  const std::string text = "// INICIO DO ARQUIVO\nM,0,0\nE,0.1\nnF,3\nF1,0\nF2,0\nF3,0\n";
  InputJob job = *ReadDamat(text, "a");

  EXPECT_EQ(*WriteDamat(job), text);
  job.layers.erase(job.layers.begin());
  EXPECT_EQ(*WriteDamat(job), "// INICIO DO ARQUIVO\nM,0,0\nnF,2\nF2,0\nF3,0\n");
}

TEST(DamatWriter, RefusesContoursThatAnIslandCannotHave) {
  InputJob job =
      *ReadDamat("nF,1\nF1,1\nI1,2,0\nC1,X0,Y0,X9,Y0,X9,Y9\nC2,X7,Y1,X8,Y1,X8,Y2\n", "a");
  v1::Island& island = *job.layers[0].mutable_islands(0);
  island.mutable_contours()->SwapElements(0, 1);
  EXPECT_EQ(WriteDamat(job).status().message(),
            "layers[0].islands[0]: DAMAT cannot hold an outer contour that is not the largest");
  island.mutable_contours()->SwapElements(0, 1);
  for (double& v : *island.mutable_contours(1)->mutable_points()) v += 100;
  EXPECT_EQ(WriteDamat(job).status().message(),
            "layers[0].islands[0]: DAMAT cannot hold a contour outside the outer one");
}

TEST(DamatWriter, WritesTheEndsOfLongerPaths) {
  InputJob job;
  v1::OpenPath& raster = *job.layers.emplace_back().add_islands()->add_rasters();
  for (const double v : {1., 2., 3., 4., 5., 6.}) raster.add_points(v);

  EXPECT_THAT(*WriteDamat(job), ::testing::HasSubstr("R0,X1,Y2,X5,Y6\n"));
}

TEST(DamatWriter, RefusesWhatTheFormatCannotHold) {
  const auto error = [](auto change) {
    InputJob job;
    v1::Layer& layer = job.layers.emplace_back();
    v1::Contour& contour = *layer.add_islands()->add_contours();
    contour.add_points(0);
    contour.add_points(0);
    change(job, layer);
    return std::string(WriteDamat(job).status().message());
  };

  EXPECT_EQ(error([](InputJob&, v1::Layer& l) { l.mutable_plan(); }),
            "layers[0]: DAMAT cannot hold a plan, only islands");
  EXPECT_EQ(error([](InputJob&, v1::Layer& l) { l.mutable_start(); }),
            "layers[0]: DAMAT cannot hold a start of the layer's own");
  EXPECT_EQ(error([](InputJob&, v1::Layer& l) { l.mutable_cost(); }),
            "layers[0]: DAMAT cannot hold a cost of the layer's own");
  EXPECT_EQ(error([](InputJob&, v1::Layer& l) {
              l.mutable_islands(0)->mutable_contours(0)->add_entries(0);
            }),
            "layers[0].islands[0].contours[0]: DAMAT cannot hold a limited choice of entries");
  EXPECT_EQ(error([](InputJob&, v1::Layer& l) {
              l.mutable_islands(0)->add_rasters()->set_one_way(true);
            }),
            "layers[0].islands[0].rasters[0]: DAMAT cannot hold a one-way path");
  EXPECT_EQ(error([](InputJob&, v1::Layer& l) {
              l.mutable_islands(0)->mutable_contours(0)->clear_points();
            }),
            "layers[0].islands[0].contours[0].points: 0 numbers, not pairs of at least 1 points");
  EXPECT_EQ(error([](InputJob& job, v1::Layer&) { job.layers.emplace_back(); }),
            "layers[1]: DAMAT cannot hold the same id twice");
}

}  // namespace
}  // namespace traverse
