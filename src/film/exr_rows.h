// Rows of a picture as the chunks of an EXR file: rounded, and compressed by ZIP.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "backlight/film/exr.h"

namespace backlight {

/// What a file has before its first chunk: the header, and an empty table of the chunks' places. Throws as
/// to_imf does.
std::string head_of(const ImageLayout& layout, const ExrHeader& header);

/// Rows as a picture of their own.
ImageLayout layout_of_rows(const ImageLayout& layout, int first, int rows);

/// Throws std::runtime_error if a value of a channel of half precision is beyond its range. Whether it is
/// such a channel and all values are finite.
bool require_half(std::span<const float> values, const ChannelInfo& channel);

/// The chunks of a picture of whole chunks, with the bytes that OpenEXR writes. A chunk knows nothing of its
/// place: a file that has other rows too has the same. Throws as require_half does.
std::string chunks_of_rows(const ImageLayout& rows, std::span<const std::span<const float>> planes);

/// The pixels of such chunks.
void decode_rows(const ImageLayout& rows, const std::string& chunks,
                 std::span<const std::span<float>> planes);

/// The place of each chunk in `chunks`, which begin at `begin` in their file; and the table of such places.
std::vector<std::uint64_t> places_of(const std::string& chunks, std::uint64_t begin);
std::string table_of(const std::vector<std::uint64_t>& places);

}  // namespace backlight
