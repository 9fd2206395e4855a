#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace coppice {

/// Writes XML with text inside elements, which Element does not hold. Elements close when their scope ends.
class XmlWriter {
 public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;

  class Scope {
   public:
    Scope(XmlWriter& writer, std::string name) : writer_(writer), name_(std::move(name)) {}
    ~Scope() { writer_.close(name_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    XmlWriter& writer_;
    std::string name_;
  };

  [[nodiscard]] Scope open(const std::string& name, const Attributes& attributes = {});
  void leaf(const std::string& name, const Attributes& attributes);
  /// An XSD annotation with a text.
  void documentation(std::string_view text);

  const std::string& text() const { return text_; }

 private:
  void tag(const std::string& name, const Attributes& attributes, std::string_view end);
  void close(const std::string& name);

  std::string text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  std::size_t depth_ = 0;
};

}  // namespace coppice
