#include "reports/exports/onnx_graph.h"

namespace coppice {
namespace {

// Numbers of onnx.proto.
constexpr std::int64_t kIrVersion = 8, kOpset = 15, kMlOpset = 3;
constexpr std::int64_t kFloat = 1, kInt64 = 7, kBool = 9;                            // TensorProto.DataType
constexpr std::int64_t kInt = 2, kString = 3, kFloats = 6, kInts = 7, kStrings = 8;  // AttributeProto.Type

ProtobufMessage named_attribute(std::string_view name, std::int64_t type) {
  ProtobufMessage message;
  message.text(1, name).integer(20, type);
  return message;
}

/// ValueInfoProto of a float tensor [rows, columns].
ProtobufMessage table(std::string_view name, std::size_t columns) {
  ProtobufMessage rows, fixed, shape, tensor, type, value;
  rows.text(2, "rows");
  fixed.integer(1, static_cast<std::int64_t>(columns));
  shape.message(1, rows).message(1, fixed);
  tensor.integer(1, kFloat).message(2, shape);
  type.message(1, tensor);
  value.text(1, name).message(2, type);
  return value;
}

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

ProtobufMessage opset(std::string_view domain, std::int64_t version) {
  ProtobufMessage message;
  message.text(1, domain).integer(2, version);
  return message;
}

}  // namespace

OnnxAttribute::OnnxAttribute(std::string_view name, std::int64_t value)
    : message(named_attribute(name, kInt)) {
  message.integer(3, value);
}
OnnxAttribute::OnnxAttribute(std::string_view name, std::string_view value)
    : message(named_attribute(name, kString)) {
  message.text(4, value);
}
OnnxAttribute::OnnxAttribute(std::string_view name, const std::vector<std::int64_t>& values)
    : message(named_attribute(name, kInts)) {
  message.integers(8, values);
}
OnnxAttribute::OnnxAttribute(std::string_view name, const std::vector<float>& values)
    : message(named_attribute(name, kFloats)) {
  message.reals(7, values);
}
OnnxAttribute::OnnxAttribute(std::string_view name, const std::vector<std::string_view>& values)
    : message(named_attribute(name, kStrings)) {
  for (const std::string_view value : values) message.text(9, value);
}

OnnxGraph::Name OnnxGraph::input(std::string_view name, std::size_t columns) {
  inputs_.message(11, table(name, columns));
  return std::string(name);
}

OnnxGraph::Name OnnxGraph::tensor(const std::vector<std::int64_t>& shape, std::int64_t type,
                                  std::string_view bytes) {
  Name name = "c" + std::to_string(values_++);
  ProtobufMessage message;
  message.integers(1, shape).integer(2, type).text(8, name).text(9, bytes);
  initializers_.message(5, message);
  return name;
}

OnnxGraph::Name OnnxGraph::constant(const std::vector<std::int64_t>& shape,
                                    const std::vector<float>& values) {
  return tensor(shape, kFloat, bytes_of(values));
}
OnnxGraph::Name OnnxGraph::constant(const std::vector<std::int64_t>& values) {
  return tensor({static_cast<std::int64_t>(values.size())}, kInt64, bytes_of(values));
}
OnnxGraph::Name OnnxGraph::constant(const std::vector<std::uint8_t>& truths) {
  return tensor({1, static_cast<std::int64_t>(truths.size())}, kBool, bytes_of(truths));
}

OnnxGraph::Name OnnxGraph::node(std::string_view op, const std::vector<Name>& inputs,
                                const std::vector<OnnxAttribute>& attributes, bool ml) {
  Name name = "v" + std::to_string(values_++);
  ProtobufMessage message;
  for (const Name& input : inputs) message.text(1, input);
  message.text(2, name).text(3, "node_" + name).text(4, op);
  for (const OnnxAttribute& attribute : attributes) message.message(5, attribute.message);
  if (ml) message.text(7, "ai.onnx.ml");
  nodes_.message(1, message);
  return name;
}

void OnnxGraph::output(std::string_view name, const Name& value, std::size_t columns) {
  ProtobufMessage message;
  message.text(1, value).text(2, name).text(3, "node_output").text(4, "Identity");
  nodes_.message(1, message);
  outputs_.message(12, table(name, columns));
}

std::string OnnxGraph::model(const std::string& writer,
                             const std::vector<std::pair<std::string, std::string>>& metadata) const {
  const std::size_t blank = writer.find(' ');
  ProtobufMessage name, model;
  name.text(2, name_);
  model.integer(1, kIrVersion).text(2, writer.substr(0, blank));
  if (blank != std::string::npos) model.text(3, writer.substr(blank + 1));
  // A message is the concatenation of its fields.
  model.text(7, nodes_.bytes() + name.bytes() + initializers_.bytes() + inputs_.bytes() + outputs_.bytes());
  model.message(8, opset("", kOpset)).message(8, opset("ai.onnx.ml", kMlOpset));
  for (const auto& [key, value] : metadata) {
    ProtobufMessage entry;
    entry.text(1, key).text(2, value);
    model.message(14, entry);
  }
  return model.bytes();
}

}  // namespace coppice
