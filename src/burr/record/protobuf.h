// record/protobuf.h - the part of Protocol Buffers that a recording needs (protobuf.dev/programming-guides/encoding):
// fields to bytes and back, and a schema of a message with the meaning of each field.
//
// For use of this room only. Thread: any; functions without state. Errors: what is malformed gives false, or a BytesIn
// that is no longer ok().
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "burr/record/mcap/mcap_bytes.h"

namespace burr::record::protobuf {

inline constexpr std::uint32_t kVarint = 0, kFixed64 = 1, kBlock = 2, kFixed32 = 5;

void put_varint(BytesOut& out, std::uint64_t value);
void put_number(BytesOut& out, std::uint32_t field, std::uint64_t value);
void put_block(BytesOut& out, std::uint32_t field, ByteSpan bytes);
void put_block(BytesOut& out, std::uint32_t field, std::string_view text);
[[nodiscard]] std::uint64_t get_varint(BytesIn& in);

// Calls found(field, number, block) for each field; false: malformed.
template <class Found>
bool each_field(ByteSpan message, Found&& found) {
  BytesIn in(message);
  while (in.ok() && !in.empty()) {
    const std::uint64_t tag = get_varint(in);
    std::uint64_t number = 0;
    ByteSpan block;
    switch (tag & 7U) {
      case kVarint:
        number = get_varint(in);
        break;
      case kFixed64:
        number = in.get<std::uint64_t>();
        break;
      case kBlock:
        block = in.take(get_varint(in));
        break;
      case kFixed32:
        number = in.get<std::uint32_t>();
        break;
      default:
        return false;
    }
    if (!in.ok() || !found(tag >> 3, number, block)) return false;
  }
  return in.ok();
}

// ---- fields with a name and a meaning

enum class Type : std::uint8_t { f64, f32, u64, u32, i64, i32, flag, number, bytes };

// Bytes of one value.
[[nodiscard]] std::size_t width(Type type);

struct FieldText {
  std::uint32_t number;
  const char* name;
  Type type;
  const char* meaning;  // with the unit in brackets
};

// A FileDescriptorSet (google/protobuf/descriptor.proto) of one message; a field that is neither Type::number nor
// Type::bytes has many values, packed.
[[nodiscard]] std::string descriptor(const char* message_name, std::span<const FieldText> fields);

}  // namespace burr::record::protobuf
