#include "burr/record/protobuf.h"

#include <limits>

namespace burr::record::protobuf {
namespace {

void put_tag(BytesOut& out, std::uint32_t field, std::uint32_t wire) {
  put_varint(out, (std::uint64_t{field} << 3) | wire);
}

// FieldDescriptorProto.Type
std::uint64_t proto_type(Type type) {
  switch (type) {
    case Type::f64:
      return 1;  // double
    case Type::f32:
      return 2;  // float
    case Type::u64:
      return 6;  // fixed64
    case Type::u32:
      return 7;  // fixed32
    case Type::i64:
      return 16;  // sfixed64
    case Type::i32:
      return 15;  // sfixed32
    case Type::flag:
      return 8;  // bool
    case Type::number:
      return 4;  // uint64, once
    case Type::bytes:
      return 12;
  }
  return 12;
}

}  // namespace

void put_varint(BytesOut& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.put(static_cast<std::uint8_t>(value | 0x80));
  out.put(static_cast<std::uint8_t>(value));
}
void put_number(BytesOut& out, std::uint32_t field, std::uint64_t value) {
  put_tag(out, field, kVarint);
  put_varint(out, value);
}
void put_block(BytesOut& out, std::uint32_t field, ByteSpan bytes) {
  put_tag(out, field, kBlock);
  put_varint(out, bytes.size());
  out.raw(bytes);
}
void put_block(BytesOut& out, std::uint32_t field, std::string_view text) {
  put_block(out, field, as_bytes(text));
}

std::uint64_t get_varint(BytesIn& in) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = in.get<std::uint8_t>();
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if ((byte & 0x80U) == 0) return value;
  }
  in.take(std::numeric_limits<std::uint64_t>::max());  // too long: makes ok() false
  return 0;
}

std::size_t width(Type type) {
  switch (type) {
    case Type::f64:
    case Type::u64:
    case Type::i64:
      return 8;
    case Type::f32:
    case Type::u32:
    case Type::i32:
      return 4;
    default:
      return 1;
  }
}

// Written by hand.
std::string descriptor(const char* message_name, std::span<const FieldText> fields) {
  BytesOut type;
  put_block(type, 1, std::string_view(message_name));
  for (const FieldText& text : fields) {
    const bool repeated = text.type != Type::number && text.type != Type::bytes;
    BytesOut field;
    put_block(field, 1, std::string_view(text.name));
    put_number(field, 3, text.number);
    put_number(field, 4, repeated ? 3 : 1);  // label
    put_number(field, 5, proto_type(text.type));
    put_block(type, 2, field.span());
  }
  // comments: path to the field [message_type, 0, field, i], an invented position, and the text
  BytesOut comments;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    BytesOut path, place, location;
    for (const std::uint64_t step : {std::uint64_t{4}, std::uint64_t{0}, std::uint64_t{2}})
      put_varint(path, step);
    put_varint(path, i);
    for (const std::uint64_t number : {i + 4, std::size_t{2}, std::size_t{40}})
      put_varint(place, number);
    put_block(location, 1, path.span());
    put_block(location, 2, place.span());
    put_block(location, 3, std::string_view(fields[i].meaning));
    put_block(comments, 1, location.span());
  }
  BytesOut file;
  put_block(file, 1, std::string("burr/") + message_name + ".proto");
  put_block(file, 2, std::string_view("burr"));
  put_block(file, 4, type.span());
  put_block(file, 9, comments.span());
  put_block(file, 12, std::string_view("proto3"));
  BytesOut set;
  put_block(set, 1, file.span());
  return std::string(as_text(set.span()));
}

}  // namespace burr::record::protobuf
