#include "engine/data/hash.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <memory>
#include <vector>

#include "engine/data/file_system.h"

namespace coppice {
namespace {

std::string hexadecimal(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string content_hash(std::string_view bytes) {
  return hexadecimal(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string file_hash(const std::filesystem::path& file) {
  const OpenFile input(file, O_RDONLY);
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::vector<char> buffer(1 << 18);
  while (const std::size_t count = input.read(buffer.data(), buffer.size())) {
    XXH3_128bits_update(state.get(), buffer.data(), count);
  }
  return hexadecimal(XXH3_128bits_digest(state.get()));
}

}  // namespace coppice
