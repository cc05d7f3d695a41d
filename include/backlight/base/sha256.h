// SHA-256, by which a picture's header names the scene that made it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace backlight {

/// SHA-256 of a sequence of bytes given in any number of pieces (FIPS 180-4, section 6.2).
class Sha256 {
 public:
  using Digest = std::array<std::byte, 32>;

  void update(std::span<const std::byte> bytes);
  void update(std::string_view text);

  /// The digest of all bytes so far. The object is then used up.
  [[nodiscard]] Digest finish();

 private:
  void process_block();

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, 64> block_{};
  std::size_t filled_ = 0;    ///< bytes waiting in `block_`
  std::uint64_t length_ = 0;  ///< bytes so far
};

/// The digest of `text` as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view text);

/// A digest as 64 lower-case hexadecimal digits.
std::string to_hex(const Sha256::Digest& digest);

}  // namespace backlight
