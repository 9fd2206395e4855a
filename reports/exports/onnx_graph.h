#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/exports/protobuf.h"

namespace coppice {

/// An attribute of an ONNX node.
struct OnnxAttribute {
  ProtobufMessage message;
  OnnxAttribute(std::string_view name, std::int64_t value);
  OnnxAttribute(std::string_view name, std::string_view value);
  OnnxAttribute(std::string_view name, const char* value) : OnnxAttribute(name, std::string_view(value)) {}
  OnnxAttribute(std::string_view name, const std::vector<std::int64_t>& values);
  OnnxAttribute(std::string_view name, const std::vector<float>& values);
  OnnxAttribute(std::string_view name, const std::vector<std::string_view>& values);
};

/// An ONNX graph in single precision, built from its inputs to its output (onnx.proto of
/// github.com/onnx/onnx; opset 15, ai.onnx.ml 3, which runtimes since 2022 know). Values are named when they
/// are made.
class OnnxGraph {
 public:
  using Name = std::string;

  explicit OnnxGraph(std::string name) : name_(std::move(name)) {}

  /// The input: any number of rows of `columns` numbers.
  Name input(std::string_view name, std::size_t columns);
  Name constant(const std::vector<std::int64_t>& shape, const std::vector<float>& values);
  Name constant(const std::vector<std::int64_t>& values);
  Name constant(const std::vector<std::uint8_t>& truths);
  /// What an operator makes of `inputs`; of domain ai.onnx.ml when `ml`.
  Name node(std::string_view op, const std::vector<Name>& inputs,
            const std::vector<OnnxAttribute>& attributes = {}, bool ml = false);
  /// Names a value as the output, rows of `columns` numbers.
  void output(std::string_view name, const Name& value, std::size_t columns);

  /// The whole file. `writer` is a name and a version with a blank between.
  std::string model(const std::string& writer,
                    const std::vector<std::pair<std::string, std::string>>& metadata) const;

 private:
  Name tensor(const std::vector<std::int64_t>& shape, std::int64_t type, std::string_view bytes);
  std::string name_;
  ProtobufMessage nodes_, initializers_, inputs_, outputs_;  // fields of GraphProto
  int values_ = 0;
};

}  // namespace coppice
