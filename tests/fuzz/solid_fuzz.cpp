// libFuzzer entry: any bytes are a solid and rays at it; along each ray the surfaces that are found are just
// where the line gets into the solid or out of it, and their normals point outward.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "solid_oracle.h"

namespace {

using namespace backlight;

/// Numbers from bytes, zeros when these have come to an end. Of 256 steps: so faces coincide now and then.
class Bytes final : public testing::Choices {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  double uniform(double low, double high) override { return low + (high - low) * next() / 256.0; }
  int below(int count) override { return next() % count; }
  [[nodiscard]] bool at_end() const { return used_ >= size_; }

 private:
  int next() { return at_end() ? 0 : data_[used_++]; }

  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t used_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  SolidTree tree;
  tree.operation = static_cast<SolidOperation>(bytes.below(3));
  for (int i = bytes.below(3); i >= 0; --i) tree.parts.push_back(testing::some_solid(bytes, 3));
  if (!problem(tree).empty()) std::abort();
  SurfaceSet set;
  set.add(csg(tree), Placement{});
  set.build();
  testing::Looked looked;
  for (int ray = 0; ray < 8 && (ray == 0 || !bytes.at_end()); ++ray) {
    const Vec3 origin = bytes.vector(2.0);
    // Off the directions of faces, along which rounding decides what is inside.
    const Vec3 direction = glm::normalize(bytes.vector(1.0) + Vec3{0.00131, 0.00217, 0.00359});
    const std::string wrong = testing::wrong_along(tree, set, origin, direction, looked);
    if (wrong.empty()) continue;
    std::fprintf(stderr, "ray %d: %s\n", ray, wrong.c_str());
    std::abort();
  }
  return 0;
}
