// What mirrors and glass do not show.
#include <algorithm>
#include <utility>

#include "compile_parts.h"

namespace backlight {

void tell_of_mirrors(Compilation& c) {
  if (std::exchange(c.parts.mirrors_are_told_of, true) || c.scene.sky.stars.empty()) return;
  const auto passes = [&](const SceneFrame& frame) { return passes_on(c.scene, frame); };
  if (std::ranges::none_of(c.scene.frames, passes)) return;
  const Node& background = find(c.values.description.root, "background")->node;
  c.values.diagnostics.warning(c.values.description.span(find(background, "stars")->node.place),
                               "stars, which are points, are not seen in mirrors, nor through glass",
                               "a 'texture' of the background is");
}

}  // namespace backlight
