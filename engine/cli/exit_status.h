#pragma once

namespace coppice::cli {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;          ///< a node failed, or the system refused something
inline constexpr int kBadUsage = 2;        ///< usage or config error; nothing was run
inline constexpr int kInterrupted = 3;     ///< stopped by the user; the same command goes on
inline constexpr int kInternalError = 70;  ///< a mistake of the program (EX_SOFTWARE of sysexits.h)

}  // namespace coppice::cli
