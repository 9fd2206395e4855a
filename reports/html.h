#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace coppice::html {

// HTML that is XML, too: every element is closed, every text escaped.

/// A text as it may stand between tags and in attributes. Characters that XML forbids become U+FFFD.
std::string escaped(std::string_view text);

/// A path relative to the page as an attribute's value: everything but letters, digits and "-._~/" becomes
/// %XX.
std::string link(std::string_view path);

using Attributes = std::vector<std::pair<std::string_view, std::string>>;

/// <name attributes>content</name>; `content` is HTML, the attributes' values are texts.
std::string element(std::string_view name, std::string_view content, const Attributes& attributes = {});

/// The same around a text.
std::string text_element(std::string_view name, std::string_view text, const Attributes& attributes = {});

}  // namespace coppice::html
