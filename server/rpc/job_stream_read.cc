// How JobStream reads messages: checks, translates and adds their layers.

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "server/rpc/job_stream.h"

namespace traverse {
namespace {

// Messages up to this size are read on gRPC's own thread; a reaction must be
// quick.
constexpr size_t kReadHereBytes = 32 << 10;

// How much of a larger one is read at once: about a millisecond's work.
constexpr int64_t kPieceBytes = 64 << 10;

absl::Status OverLimit(const std::string& place, int64_t found, const char* what, int64_t limit) {
  return absl::ResourceExhaustedError(
      absl::StrCat(place, ": ", found, " ", what, ", more than this server's limit of ", limit));
}

}  // namespace

absl::Status JobStream::CheckSize(const v1::Layer& layer, uint64_t index, int64_t points) const {
  const std::string place = absl::StrCat("layers[", index, "]");
  const int64_t limit = core_.limits.max_points_per_layer;
  if (points > limit) {
    core_.admission.CountRefusal(Refusal::kLayerPoints);
    return OverLimit(place, points, "points", limit);
  }
  // Islands, nodes and pairs may be empty, but they take memory all the same.
  int64_t pairs = 0;
  Budget turns(nullptr, std::nullopt, queue_->turn());
  Rest rest(&turns);
  for (const v1::PlanNode& node : layer.plan().nodes()) {
    rest(8);
    pairs += node.any_order().before_size();
  }
  const int64_t parts =
      std::max<int64_t>(pairs, std::max<int64_t>(layer.islands_size(), layer.plan().nodes_size()));
  if (parts / 4 > limit) {
    core_.admission.CountRefusal(Refusal::kLayerPoints);
    return OverLimit(place, parts, "islands, nodes or pairs", 4 * limit);
  }
  return absl::OkStatus();
}

absl::Status JobStream::CheckLayerCount(int64_t more) const {
  const JobLimits& limits = core_.limits;
  const int64_t total = layers_received() + more;
  if (more > limits.max_layers_per_message) {
    core_.admission.CountRefusal(Refusal::kJobLayers);
    return OverLimit("layers", more, "layers in a message", limits.max_layers_per_message);
  }
  if (limits.max_layers_per_job > 0 && total > limits.max_layers_per_job) {
    core_.admission.CountRefusal(Refusal::kJobLayers);
    return OverLimit("layers", total, "layers", limits.max_layers_per_job);
  }
  return absl::OkStatus();
}

absl::StatusOr<LabelledLayer> JobStream::Translate(const v1::Layer& layer, uint64_t index) const {
  Budget turns(nullptr, std::nullopt, queue_->turn());
  const int64_t points = CountPoints(layer, &turns);
  if (absl::Status status = CheckSize(layer, index, points); !status.ok()) return status;
  absl::StatusOr<LabelledLayer> value = LayerFromProto(layer, index, setup_.interleaved, &turns);
  if (!value.ok()) return value;
  value->label.points = std::max<int64_t>(1, points);
  value->label.bytes = reader_.layer_footprint_bytes();
  return value;
}

std::optional<LabelledLayer> JobStream::InPlaceOf(const v1::Layer& layer,
                                                  const absl::Status& fault) const {
  const bool of_layer = FaultList::IsFault(fault) || absl::IsResourceExhausted(fault);
  if (!of_layer || !setup_.partial_answers || setup_.validate_only || !faults_.empty())
    return std::nullopt;
  constexpr size_t kMostBytes = 1000;
  LabelledLayer in_place;
  in_place.label.id = layer.id();
  in_place.label.bytes = reader_.layer_footprint_bytes();
  in_place.label.fault = Beginning(std::string(fault.message()), kMostBytes);
  return in_place;
}

void JobStream::ReadMessage(grpc::ByteBuffer& message) {
  const std::shared_ptr<JobRun> run = run_;
  if (!run->Hold()) return;  // the call was cancelled while its message came in
  opened_ = false;
  const auto bytes = static_cast<int64_t>(message.Length());
  core_.OnMessage(call_.peer, bytes);
  if (absl::Status status = CheckMessage(bytes); !status.ok()) {
    run->Abort(status);
    run->Release();
    return;
  }
  if (message.Length() > kReadHereBytes) return ReadPiecesInTurns(message);
  while (ReadPiece(message)) {
  }
  run->Release();  // may end the call
}

void JobStream::ReadPiecesInTurns(grpc::ByteBuffer& message) {
  const std::shared_ptr<JobRun> run = run_;
  const absl::Status submitted = Guarded([&] {
    queue_->Submit([this, &message, run] {
      if (ReadPiece(message)) return ReadPiecesInTurns(message);
      run->Release();  // may end the call
    });
    return absl::OkStatus();
  });
  if (submitted.ok()) return;
  run->Abort(submitted);
  run->Release();
}

bool JobStream::ReadPiece(grpc::ByteBuffer& message) {
  if (run_->aborted()) return false;
  const absl::Status status =
      Guarded([&] { return opened_ ? ReadLayers() : OpenMessage(message); });
  if (!status.ok()) {
    run_->Abort(status);
    return false;
  }
  if (reader_.left() > 0) return true;
  ticket_->LetGo(std::exchange(message_bytes_, 0));
  if (setup_.validate_only) ticket_->LetGo(reader_.footprint_bytes());
  OnMessageRead();
  return false;
}

// The bytes of the message count until it is read; the memory of its layers, while they are kept.
absl::Status JobStream::CheckMessage(int64_t bytes) {
  if (bytes > core_.limits.max_message_bytes) {
    core_.admission.CountRefusal(Refusal::kMessage);
    return OverLimit("the message", bytes, "bytes", core_.limits.max_message_bytes);
  }
  if (absl::Status status = ticket_->Hold(bytes); !status.ok()) return status;
  message_bytes_ = bytes;
  return absl::OkStatus();
}

absl::Status JobStream::OpenMessage(grpc::ByteBuffer& message) {
  const RequestLimits limits = {.parts_of_layer = 4 * core_.limits.max_points_per_layer,
                                .footprint_bytes = core_.limits.max_bytes_per_message,
                                .layers = core_.limits.max_layers_per_message};
  const auto goes_on = [this] {
    Budget(nullptr, std::nullopt, queue_->turn()).Exhausted();
    return !run_->aborted();
  };
  if (absl::Status status = reader_.Open(RequestType(), message, limits, goes_on); !status.ok()) {
    if (absl::IsResourceExhausted(status)) core_.admission.CountRefusal(Refusal::kLayerPoints);
    return status;
  }
  opened_ = true;
  faults_ = FaultList();
  if (absl::Status status = OnOptions(reader_); !status.ok()) {
    if (!FaultList::IsFault(status) || reader_.layers() == 0) return status;
    faults_.Add(status);  // also reports faults of the layers
  }
  if (absl::Status status = CheckLayerCount(reader_.layers()); !status.ok()) return status;
  return ticket_->Hold(reader_.footprint_bytes(), message_bytes_);
}

absl::Status JobStream::ReadLayers() {
  std::vector<LabelledLayer> layers = std::exchange(carried_, {});
  uint64_t faulty = 0;
  int64_t points = points_received_;
  for (const LabelledLayer& layer : layers) points += layer.label.points;
  const auto take = [&](const v1::Layer& message) -> absl::Status {
    const uint64_t index = layers_received_ + layers.size() + faulty;
    absl::StatusOr<LabelledLayer> layer = Translate(message, index);
    if (std::optional<LabelledLayer> fault = InPlaceOf(message, layer.status()); fault) {
      layers.push_back(*std::move(fault));
      return absl::OkStatus();
    }
    if (FaultList::IsFault(layer.status())) {
      faults_.Add(layer.status());
      ++faulty;
      return faults_.full() ? faults_.status() : absl::OkStatus();
    }
    if (!layer.ok()) return layer.status();
    points += layer->label.points;
    if (core_.limits.max_points_per_job > 0 && points > core_.limits.max_points_per_job) {
      core_.admission.CountRefusal(Refusal::kJobPoints);
      return OverLimit(absl::StrCat("layers[", index, "]"), points, "points up to here",
                       core_.limits.max_points_per_job);
    }
    layers.push_back(*std::move(layer));
    return absl::OkStatus();
  };
  if (absl::Status status = reader_.Read(kPieceBytes, take); !status.ok()) return status;
  if (!faults_.empty()) {
    layers_received_ += layers.size() + faulty;
    return reader_.left() == 0 ? faults_.status() : absl::OkStatus();
  }
  // Depends only on what was sent: pieces, and what has arrived, must not change a route.
  for (LabelledLayer& layer : layers) layer.layer.more_follows = true;
  const auto last = std::find_if(layers.rbegin(), layers.rend(), [](const LabelledLayer& layer) {
    return layer.label.fault.empty();
  });
  if (reader_.left() == 0) {
    if (last != layers.rend()) last->layer.more_follows = MoreFollowsMessage();
  } else if (setup_.partial_answers && last != layers.rend()) {
    // The layers that follow may all be faulty, and then none follows it.
    const auto first = std::prev(last.base());
    carried_.assign(std::move_iterator(first), std::move_iterator(layers.end()));
    layers.erase(first, layers.end());
  }
  AddLayers(std::move(layers));
  return absl::OkStatus();
}

}  // namespace traverse
