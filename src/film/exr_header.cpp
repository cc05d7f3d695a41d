#include "exr_header.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <ImfTileDescription.h>
#include <ImfVecAttribute.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <set>
#include <sstream>
#include <stdexcept>

namespace backlight {
namespace {

Imath::Box2i to_imath(const PixelBox& box) {
  return {Imath::V2i(box.x0, box.y0), Imath::V2i(box.x1 - 1, box.y1 - 1)};
}

/// Each type of ExrValue as OpenEXR's attribute.
struct AttributeInserter {
  Imf::Header& header;
  const std::string& name;

  void operator()(std::int32_t value) const { header.insert(name, Imf::IntAttribute(value)); }
  void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
  void operator()(double value) const { header.insert(name, Imf::DoubleAttribute(value)); }
  void operator()(const std::string& value) const { header.insert(name, Imf::StringAttribute(value)); }
  void operator()(const Vec3& value) const {
    header.insert(name, Imf::V3dAttribute(Imath::V3d(value.x, value.y, value.z)));
  }
  void operator()(const VariantGuard& /*never*/) const {}
  void operator()(const std::vector<std::string>& value) const {
    header.insert(name, Imf::StringVectorAttribute(value));
  }
};

void add_creation_time(Imf::Header& header, std::int64_t seconds) {
  const std::time_t time = seconds;
  std::tm utc{};
  if (::gmtime_r(&time, &utc) == nullptr) {
    throw std::runtime_error("the creation time is out of range");
  }
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y:%m:%d %H:%M:%S", &utc);
  Imf::addCapDate(header, text.data());
  Imf::addUtcOffset(header, 0.0F);
}

PixelBox from_imath(const Imath::Box2i& box) {
  constexpr int limit = 1 << 30;  // keeps the sums below from overflowing, whatever a damaged file says
  constexpr int greatest_extent = 1 << 20;
  constexpr std::int64_t greatest_area = std::int64_t{1} << 32;
  if (box.min.x < -limit || box.min.y < -limit || box.max.x > limit || box.max.y > limit ||
      box.max.x < box.min.x || box.max.y < box.min.y) {
    throw std::runtime_error("its windows make no sense");
  }
  const PixelBox result{box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
  if (result.width() > greatest_extent || result.height() > greatest_extent ||
      std::int64_t{result.width()} * result.height() > greatest_area) {
    throw std::runtime_error("it says that it has " + std::to_string(result.width()) + " x " +
                             std::to_string(result.height()) + " pixels");
  }
  return result;
}

/// The attribute's value if it is of one of ExrValue's types.
std::optional<ExrValue> to_value(const Imf::Attribute& attribute) {
  if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
    return integer->value();
  }
  if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
    return single->value();
  }
  if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
    return real->value();
  }
  if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
    return text->value();
  }
  if (const auto* vector = dynamic_cast<const Imf::V3dAttribute*>(&attribute)) {
    return Vec3{vector->value().x, vector->value().y, vector->value().z};
  }
  if (const auto* texts = dynamic_cast<const Imf::StringVectorAttribute*>(&attribute)) {
    return texts->value();
  }
  return std::nullopt;
}

/// Attributes that have a place of their own in ExrInfo.
bool has_own_place(const std::string& name) {
  static const std::set<std::string> names{
      "Software",         "comments",          "whiteLuminance", "worldToCamera", "multiView",
      "pixelAspectRatio", "screenWindowWidth", "name",           "type",          "chunkCount"};
  return names.contains(name);
}

}  // namespace

void begin_exr() {
  Imf::staticInitialize();
}

std::string text_of(const ExrValue& value) {
  std::ostringstream text;
  text << std::setprecision(17);
  if (const auto* whole = std::get_if<std::int32_t>(&value)) text << *whole;
  if (const auto* single = std::get_if<float>(&value)) text << std::setprecision(9) << *single;
  if (const auto* number = std::get_if<double>(&value)) text << *number;
  if (const auto* string = std::get_if<std::string>(&value)) text << *string;
  if (const auto* vector = std::get_if<Vec3>(&value))
    text << vector->x << ' ' << vector->y << ' ' << vector->z;
  if (const auto* list = std::get_if<std::vector<std::string>>(&value)) {
    for (const std::string& item : *list) text << (&item == &list->front() ? "" : ", ") << item;
  }
  return text.str();
}

Imf::Header to_imf(const ImageLayout& layout, const ExrHeader& description) {
  Imf::Header header(to_imath(layout.display), to_imath(layout.data), 1.0F, Imath::V2f(0.0F, 0.0F), 1.0F,
                     Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  std::set<std::string> reserved;
  for (auto entry = header.begin(); entry != header.end(); ++entry) {
    reserved.insert(entry.name());
  }
  for (const ExrAttribute& attribute : description.attributes) {
    if (attribute.name.empty() || reserved.contains(attribute.name)) {
      throw std::runtime_error("'" + attribute.name + "' cannot be the name of a further attribute");
    }
    std::visit(AttributeInserter{header, attribute.name}, attribute.value);
  }
  for (const ChannelInfo& channel : layout.channels) {
    const bool half = channel.precision == ChannelPrecision::half;
    header.channels().insert(channel.name, Imf::Channel(half ? Imf::HALF : Imf::FLOAT));
  }
  Imf::addChromaticities(header, Imf::Chromaticities());  // the default: Rec.709 and D65
  Imf::addWhiteLuminance(header, description.white_luminance);
  if (!layout.views.empty()) {
    Imf::addMultiView(header, layout.views);
  }
  if (description.world_to_camera) {
    Imath::M44f matrix;
    std::copy_n(description.world_to_camera->begin(), 16, matrix.getValue());
    Imf::addWorldToCamera(header, matrix);
  }
  if (!description.software.empty()) {
    header.insert("Software", Imf::StringAttribute(description.software));
  }
  if (!description.comments.empty()) {
    Imf::addComments(header, description.comments);
  }
  if (description.creation_time) {
    add_creation_time(header, *description.creation_time);
  }
  return header;
}

namespace {

ChannelPrecision from_imf(Imf::PixelType type) {
  if (type == Imf::UINT) return ChannelPrecision::whole;
  return type == Imf::HALF ? ChannelPrecision::half : ChannelPrecision::single;
}

void add_channels(ExrInfo& info, const Imf::ChannelList& channels) {
  for (auto entry = channels.begin(); entry != channels.end(); ++entry) {
    if (entry.channel().xSampling != 1 || entry.channel().ySampling != 1) {
      info.unreadable = "its channel " + std::string(entry.name()) + " is subsampled";
    }
    info.layout.channels.push_back({entry.name(), from_imf(entry.channel().type)});
  }
}

void add_storage(ExrInfo& info, const Imf::Header& header) {
  info.part = header.hasName() ? header.name() : "";
  info.pixel_aspect = header.pixelAspectRatio();
  const Imf::Chromaticities colours =
      Imf::hasChromaticities(header) ? Imf::chromaticities(header) : Imf::Chromaticities();
  info.chromaticities = {colours.red.x,  colours.red.y,  colours.green.x, colours.green.y,
                         colours.blue.x, colours.blue.y, colours.white.x, colours.white.y};
  const std::string type = header.hasType() ? header.type() : "";
  info.tiled = header.hasTileDescription();
  info.storage = "scanlines";
  if (info.tiled) {
    const Imf::TileDescription& tiles = header.tileDescription();
    info.storage = "tiles of " + std::to_string(tiles.xSize) + " x " + std::to_string(tiles.ySize);
    info.has_levels = tiles.mode != Imf::ONE_LEVEL;
    if (info.has_levels) info.storage += ", and smaller levels";
  }
  if (type.starts_with("deep")) {
    info.unreadable = "it is a deep picture";
    info.storage = type == Imf::DEEPTILE ? "deep tiles" : "deep scanlines";
  } else if (!type.empty() && type != Imf::SCANLINEIMAGE && type != Imf::TILEDIMAGE) {
    info.unreadable = "it is of an unknown kind, '" + type + "'";
    info.storage = type;
  }
}

}  // namespace

ExrInfo from_imf(const Imf::Header& header) {
  ExrInfo info;
  add_storage(info, header);
  info.layout.display = from_imath(header.displayWindow());
  info.layout.data = from_imath(header.dataWindow());
  add_channels(info, header.channels());
  if (Imf::hasMultiView(header)) {
    info.layout.views = Imf::multiView(header);
  }
  if (Imf::hasWhiteLuminance(header)) {
    info.header.white_luminance = Imf::whiteLuminance(header);
  }
  if (Imf::hasWorldToCamera(header)) {
    info.header.world_to_camera.emplace();
    std::copy_n(Imf::worldToCamera(header).getValue(), 16, info.header.world_to_camera->begin());
  }
  if (Imf::hasComments(header)) {
    info.header.comments = Imf::comments(header);
  }
  if (const auto* software = header.findTypedAttribute<Imf::StringAttribute>("Software")) {
    info.header.software = software->value();
  }
  for (auto entry = header.begin(); entry != header.end(); ++entry) {
    if (!has_own_place(entry.name())) {
      if (std::optional<ExrValue> value = to_value(entry.attribute())) {
        info.header.attributes.push_back({entry.name(), *std::move(value)});
      }
    }
  }
  return info;
}

std::array<float, 16> world_to_camera_matrix(const Vec3& position, const Vec3& right, const Vec3& up,
                                             const Vec3& forward) {
  const std::array<Vec3, 3> axes{right, up, -forward};
  std::array<float, 16> matrix{};
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t row = 0; row < 3; ++row) {
      matrix[4 * row + column] = static_cast<float>(axes[column][static_cast<glm::length_t>(row)]);
    }
    matrix[12 + column] = static_cast<float>(-glm::dot(position, axes[column]));
  }
  matrix[15] = 1.0F;
  return matrix;
}

Result<std::optional<std::int64_t>> source_date_epoch() {
  const char* text = std::getenv("SOURCE_DATE_EPOCH");
  if (text == nullptr) {
    return std::optional<std::int64_t>{};
  }
  const std::string_view digits(text);
  // 12 digits reach beyond the year 30000.
  if (digits.empty() || digits.size() > 12 || digits.find_first_not_of("0123456789") != digits.npos) {
    return Failure{"SOURCE_DATE_EPOCH is '" + std::string(digits) + "'; expected seconds since 1970"};
  }
  return std::optional<std::int64_t>(std::stoll(text));
}

}  // namespace backlight
