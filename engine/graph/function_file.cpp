#include "engine/graph/artifacts.h"
#include "engine/graph/component_file.h"

namespace coppice {
namespace {

constexpr FileKind kFunctionFileKind = {"function", std::string_view("\x89"
                                                                     "CPF\r\n\x1a\n",
                                                                     8)};

}  // namespace

void write_function_file(const std::filesystem::path& file, const FunctionFile& content) {
  std::string body;
  append_text(body, content.writer.empty() ? writer_text() : content.writer);
  append_text(body, content.provenance);
  append_number(body, static_cast<std::uint32_t>(content.inputs.size()));
  for (const std::string& input : content.inputs) append_text(body, input);
  append_text(body, content.output);
  append_component(body, content.component, content.arrays);
  write_component_file(file, kFunctionFileKind, body);
}

FunctionFile read_function_file(const std::filesystem::path& file) {
  FunctionFile content;
  parse_component_file(component_file_bytes(file), file, kFunctionFileKind, [&](ByteReader& bytes) {
    content.writer = bytes.text("the writer's name");
    content.provenance = bytes.text("the provenance key");
    const auto inputs = bytes.number<std::uint32_t>("the number of inputs");
    for (std::uint32_t i = 0; i < inputs; ++i) content.inputs.push_back(bytes.text("an input's name"));
    content.output = bytes.text("the output's name");
    read_component(bytes, file, content.component, content.arrays);
  });
  return content;
}

MadeFunction make_function(const FunctionFile& file) {
  return make_with_arrays<Function>(file.component, file.arrays);
}

}  // namespace coppice
