// Messages to and from gRPC's buffers. The service parses messages itself, so that an invalid
// message is the caller's fault, with a status that says so, and not INTERNAL.

#ifndef TRAVERSE_SERVER_RPC_WIRE_H_
#define TRAVERSE_SERVER_RPC_WIRE_H_

#include <google/protobuf/arena.h>
#include <google/protobuf/message_lite.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/proto_buffer_reader.h>
#include <grpcpp/support/slice.h>

#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace traverse {

// Parses `buffer` into `message`. InvalidArgument if that fails.
inline absl::Status ParseMessage(const grpc::ByteBuffer& buffer,
                                 google::protobuf::MessageLite& message) {
  if (buffer.Length() == 0) return absl::OkStatus();
  // The reader takes a pointer to non-const, but changes nothing.
  grpc::ProtoBufferReader reader(const_cast<grpc::ByteBuffer*>(&buffer));
  if (reader.status().ok() && message.ParseFromZeroCopyStream(&reader)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("the message of ", buffer.Length(),
                                                 " bytes is not a valid ", message.GetTypeName()));
}

// A buffer with a copy of `bytes`.
inline grpc::ByteBuffer ToByteBuffer(const std::string& bytes) {
  const grpc::Slice slice(bytes.data(), bytes.size());
  return grpc::ByteBuffer(&slice, 1);
}

// Serialises a fresh Message after `fill` has filled it, without the heap for small ones.
template <typename Message, typename Fill>
std::string Serialize(const Fill& fill) {
  alignas(8) char block[4096];
  google::protobuf::ArenaOptions options;
  options.initial_block = block;
  options.initial_block_size = sizeof(block);
  google::protobuf::Arena arena(options);
  auto* message = google::protobuf::Arena::CreateMessage<Message>(&arena);
  fill(*message);
  return message->SerializeAsString();
}

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_WIRE_H_
