#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace coppice::cli {

/// Whole CSV records as they come in on a file descriptor, without waiting for more than is needed.
class RowStream {
 public:
  /// `before_wait` is called before each read that may block.
  RowStream(int descriptor, std::function<void()> before_wait)
      : descriptor_(descriptor), before_wait_(std::move(before_wait)) {}

  /// The next records, at least one, line ends (LF) included, without a byte order mark; nothing at the end.
  /// Throws std::runtime_error
  /// with the system's reason.
  std::optional<std::string> next();

 private:
  bool read_more();

  int descriptor_;
  std::function<void()> before_wait_;
  std::string pending_;  ///< what came after the last whole record
  bool begun_ = false;
  bool ended_ = false;
};

}  // namespace coppice::cli
