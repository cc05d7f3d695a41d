#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <unordered_map>
#include <utility>

#include "backlight/base/memory.h"
#include "compile_mesh.h"
#include "compile_motion.h"
#include "compile_shapes.h"

namespace backlight {
namespace {

constexpr double most_copies = 1e7;

// In an outline, so many copies of a lattice stand for all: more than enough for every way of searching.
constexpr std::size_t most_outlined = 10'000;

// How often, and how far apart.
struct Lattice {
  std::array<int, 3> count{1, 1, 1};
  Vec3 step{0.0};

  [[nodiscard]] std::size_t copies() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
           static_cast<std::size_t>(count[2]);
  }
  /// Of a copy, x counting fastest.
  [[nodiscard]] Vec3 offset(std::size_t copy) const {
    const auto nx = static_cast<std::size_t>(count[0]), ny = static_cast<std::size_t>(count[1]);
    return Vec3{double(copy % nx), double(copy / nx % ny), double(copy / nx / ny)} * step;
  }
};

Lattice read_lattice(const TableView& object) {
  Lattice lattice;
  if (!object.has_valid("repeat")) return lattice;
  const TableView repeat = object.table("repeat", "object.repeat");
  if (!repeat.complete()) return lattice;
  const Vec3 count = repeat.vector("count");
  lattice.step = repeat.vector("step");
  if (count.x * count.y * count.z > most_copies) {
    object.error("repeat", "more than " + number_text(most_copies) + " copies");
    return lattice;
  }
  if (count.x < 1.0 || count.y < 1.0 || count.z < 1.0) return lattice;  // reported before
  for (int i = 0; i < 3; ++i) lattice.count[static_cast<std::size_t>(i)] = static_cast<int>(count[i]);
  return lattice;
}

// The surfaces of a frame, before their search tree is made.
struct FrameBuilder {
  SurfaceSet surfaces;
  std::vector<int> object_of_surface;
  std::vector<CopiesLeftOut> left_out;

  // One object with its copies, x counting fastest.
  void add_copies(int object, const Shape& shape, const Placement& first, const Lattice& lattice,
                  const Vec3& rotate, bool outline, bool casts_shadow) {
    const std::size_t total = lattice.copies();
    const std::size_t made = outline ? std::min(total, most_outlined) : total;
    std::size_t done = 0;
    if (made < total) left_out.push_back({static_cast<int>(surfaces.size()), total - made});
    for (int k = 0; k < lattice.count[2]; ++k)
      for (int j = 0; j < lattice.count[1]; ++j)
        for (int i = 0; i < lattice.count[0]; ++i) {
          if (done++ == made) return;
          const Vec3 offset = Vec3{double(i), double(j), double(k)} * lattice.step;
          surfaces.add(shape, Placement(first.position() + offset, rotate, first.scale()), casts_shadow);
          object_of_surface.push_back(object);
        }
  }
};

// All objects of a description, for one image.
class ObjectCompiler {
 public:
  ObjectCompiler(Compilation& c, const NodeArray& written)
      : c_(c),
        written_(written),
        plan_(c.parts.objects),
        materials_(c.values, c.cache, c.parts, c.scene.film.exposure) {}

  void run() {
    if (plan_.group_of.empty()) make_plan();
    place_groups();
    is_any_glass_ = has_glass_that_shows();
    for (std::size_t i = 0; i < written_.size(); ++i) {
      const auto group = static_cast<std::size_t>(plan_.group_of[i]);
      if (!frames_[frame_of_group_[group]].reused) compile_object(static_cast<int>(i), group);
    }
    c_.scene.materials = materials_.finish(c_.scene.counts);
    if (plan_.objects.empty()) plan_.objects = std::move(objects_);
    c_.scene.objects = plan_.objects;
    if (!c_.values.diagnostics.has_errors()) finish_frames();
  }

 private:
  struct FrameOfImage {
    std::vector<int> groups;
    bool reused = false;
    std::unique_ptr<FrameBuilder> builder;  // null: nothing to add so far
  };

  [[nodiscard]] TableView table(int object) const {
    return {c_.values, &written_[static_cast<std::size_t>(object)], *find_table("object")};
  }

  void make_plan() {
    const bool c_changes = changes_with_time(find(c_.values.description.root, "c"));
    std::unordered_map<std::string, int> named;
    std::unordered_map<InertialFrame, int, HashOfFrame> moving;
    const auto group_for = [&](int object) {
      const auto next = static_cast<int>(plan_.groups.size());
      const TableView keys = table(object);
      if (is_in_motion(keys)) return next;
      if (!has_motion(keys)) {
        c_.frames.check_at_rest(keys);
        return named.emplace(keys.text("frame"), next).first->second;
      }
      if (c_changes || motion_changes(object)) return next;
      const auto motion = c_.frames.own_motion(keys);
      return motion ? moving.emplace(*motion, next).first->second
                    : named.emplace("world", next).first->second;
    };
    for (int i = 0; i < static_cast<int>(written_.size()); ++i) {
      const int group = group_for(i);
      if (group == static_cast<int>(plan_.groups.size())) plan_.groups.emplace_back();
      plan_.group_of.push_back(group);
      ObjectGroup& its = plan_.groups[static_cast<std::size_t>(group)];
      its.changes = its.changes || c_changes || surfaces_change(i);
      its.apart = is_in_motion(table(i));
      if (its.apart && !has_motion(table(i))) its.frame = table(i).text("frame");
    }
    for (const auto& [name, group] : named) plan_.groups[static_cast<std::size_t>(group)].frame = name;
    for (const auto& [motion, group] : moving) plan_.groups[static_cast<std::size_t>(group)].motion = motion;
    for (std::size_t i = 0; i < written_.size(); ++i) {
      ObjectGroup& group = plan_.groups[static_cast<std::size_t>(plan_.group_of[i])];
      if (group.frame.empty() && !group.motion) group.follows = static_cast<int>(i);
    }
  }

  [[nodiscard]] bool changes_with_time(const Entry* entry) const {
    return c_.parts.kept && entry != nullptr && c_.parts.dependence.changes(entry->node);
  }

  // Its velocity, or the place that its frame starts from.
  [[nodiscard]] bool motion_changes(int object) const {
    const Node& node = written_[static_cast<std::size_t>(object)];
    for (const std::string_view key :
         {"velocity", "beta", "gamma", "celerity", "rapidity", "along", "position"}) {
      if (changes_with_time(find(node, key))) return true;
    }
    return false;
  }

  // Materials are compiled apart from the surfaces.
  [[nodiscard]] bool surfaces_change(int object) const {
    return c_.parts.kept &&
           c_.parts.dependence.changes(written_[static_cast<std::size_t>(object)], "material");
  }

  // Which group is in which frame at this image's time, and whether all surfaces there are known.
  void place_groups() {
    for (int i = 0; i < static_cast<int>(plan_.groups.size()); ++i) {
      const ObjectGroup& group = plan_.groups[static_cast<std::size_t>(i)];
      std::optional<InertialFrame> motion = group.motion;
      if (group.follows >= 0) motion = c_.frames.own_motion(table(group.follows));
      const std::string name = motion || group.frame.empty() ? "" : group.frame;
      const InertialFrame& its = motion ? *motion : c_.frames.named(group.frame);
      const int frame = group.apart ? c_.frames.apart(its, name) : c_.frames.index_of(its, name);
      frame_of_group_.push_back(static_cast<std::size_t>(frame));
      moves_.push_back(motion.has_value());
      frames_.resize(std::max(frames_.size(), frame_of_group_.back() + 1));
      frames_[frame_of_group_.back()].groups.push_back(i);
    }
    for (FrameOfImage& frame : frames_) {
      if (frame.groups.empty()) continue;
      const ObjectGroup& first = plan_.groups[static_cast<std::size_t>(frame.groups.front())];
      frame.reused = first.surfaces != nullptr && std::equal(first.others.begin(), first.others.end(),
                                                             frame.groups.begin() + 1, frame.groups.end());
    }
  }

  void compile_object(int index, std::size_t group) {
    const TableView keys = table(index);
    const std::size_t errors = c_.values.diagnostics.error_count();
    Object object;
    object.name = keys.text("name");
    object.id = index + 1;
    object.material = materials_.of(keys);
    const Vec3 rotate = keys.vector("rotate");
    // One that moves by itself is at the origin of its frame.
    const Placement placement(moves_[group] ? Vec3{0.0} : keys.vector("position"), rotate, read_scale(keys));
    const Lattice lattice = read_lattice(keys);
    const auto compiled = compile_shape(c_, keys, materials_, object.material);
    if (compiled) object.member_materials = compiled->member_materials;
    object.casts_shadow = keys.boolean("casts_shadow");
    if (compiled) check_glass(keys, object, compiled->shape, plan_.groups[group].apart);
    const bool shades = object.casts_shadow && !materials_.is_glass(object.material);
    const int object_material = object.material;
    objects_.push_back(std::move(object));
    if (!compiled || c_.values.diagnostics.error_count() > errors) return;
    const bool apart = plan_.groups[group].apart;
    if (has_motion(keys)) check_motions_apart(keys, c_.scene.frames[frame_of_group_[group]].motion.celerity);
    if (c_.values.diagnostics.error_count() > errors) return;
    if (const std::string wrong = apart ? "" : problem(placement); !wrong.empty()) {
      return keys.error(keys.has("scale") ? "scale" : "position", wrong);
    }
    std::unique_ptr<FrameBuilder>& builder = frames_[frame_of_group_[group]].builder;
    if (!builder) builder = std::make_unique<FrameBuilder>();
    if (!leave_room(keys, lattice)) return;
    if (materials_.is_glass(object_material) && !is_any_glass_) return;
    const auto first = static_cast<int>(builder->surfaces.size());
    if (apart) {
      return add_in_motion(index, keys, static_cast<int>(frame_of_group_[group]), *compiled, lattice,
                           *builder);
    }
    const Vec3 centre = placement.position() + placement.rest_from_local() * compiled->centre;
    builder->add_copies(index, compiled->shape, Placement(centre, rotate, placement.scale()), lattice, rotate,
                        c_.request.outline, shades);
    if (!is_infinite(compiled->shape) && !(builder->surfaces.bounds(first).radius <= greatest_composed)) {
      keys.error("shape", "it is larger than " + number_text(greatest_composed) + ", all scales together");
    }
  }

  // Whether any glass has a tint, or another index than 1, or may have.
  [[nodiscard]] bool has_glass_that_shows() const {
    const auto shows = [](const Node& material) {
      const Entry* glass = material.table() != nullptr ? find(material, "glass") : nullptr;
      if (glass == nullptr || glass->node.table() == nullptr) return false;
      const Entry* index = find(glass->node, "index");
      const auto* number = index != nullptr ? std::get_if<double>(&index->node.value) : nullptr;
      return number == nullptr || *number != 1.0 || glass->node.table()->size() > 1 ||
             material.table()->size() > 1;
    };
    const Entry* named = find(c_.values.description.root, "material");
    if (named != nullptr && named->node.table() != nullptr) {
      for (const Entry& entry : *named->node.table()) {
        if (shows(entry.node)) return true;
      }
    }
    return std::ranges::any_of(written_, [&](const Node& object) {
      const Entry* own = object.table() != nullptr ? find(object, "material") : nullptr;
      return own != nullptr && shows(own->node);
    });
  }

  // Glass has an inside, all of one glass, that does not move in its frame.
  void check_glass(const TableView& keys, const Object& object, const Shape& shape, bool in_motion) const {
    const auto is_glass = [&](int material) { return materials_.is_glass(material); };
    const bool whole =
        is_glass(object.material) &&
        std::ranges::all_of(object.member_materials, [&](int its) { return its == object.material; });
    if (!is_glass(object.material) && std::ranges::none_of(object.member_materials, is_glass)) return;
    if (!whole) {
      keys.error("material", "a solid of glass is one body: its parts cannot have materials of their own",
                 "give the glass to the whole object, and let other objects stand in it");
    } else if (!is_solid(shape)) {
      keys.error("material", "glass has to enclose something, and this surface has no inside");
    } else if (in_motion) {
      keys.error("material", "glass that moves by formulas of t, or a rocket, is not computed",
                 "give it a velocity, or a frame in which it rests");
    } else if (shape.mesh) {
      require_closed(keys, "shape", *shape.mesh, "of glass");
    }
  }

  void add_in_motion(int index, const TableView& keys, int frame, const CompiledShape& compiled,
                     const Lattice& lattice, FrameBuilder& builder) {
    std::optional<MovingShape> moving;
    for (std::size_t copy = 0; copy < lattice.copies(); ++copy) {
      const Vec3 offset = lattice.offset(copy);
      const SolidTree* solid = compiled.solid ? &*compiled.solid : nullptr;
      if (!moving || !moving->proved_anywhere)
        moving = put_in_motion(c_, keys, frame, compiled.shape, solid, offset);
      if (!moving) return;
      const Placement placement = Placement(offset, Vec3{0.0}, Vec3{1.0}).around(moving->placement);
      builder.surfaces.add(moving->shape, placement, keys.boolean("casts_shadow"));
      builder.object_of_surface.push_back(index);
    }
  }

  // Surfaces are counted before they take memory. What is only told of need not fit here.
  bool leave_room(const TableView& keys, const Lattice& lattice) {
    constexpr std::size_t many = 100'000;
    if (lattice.copies() < many) return true;
    const auto left = memory_left();
    const std::uint64_t needed = lattice.copies() * bytes_of_surface;
    if (!left || needed <= left->bytes) return true;
    const std::string message = std::to_string(lattice.copies()) + " copies take " + memory_words(needed) +
                                " of memory, and " + memory_words(left->bytes) + " are " + left->where;
    if (!c_.request.outline) keys.error("repeat", message);
    if (c_.request.outline) keys.warning("repeat", message, "to render it here is an error");
    return c_.request.outline;
  }

  void finish_frames() {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      FrameOfImage& frame = frames_[i];
      if (frame.groups.empty()) continue;
      ObjectGroup& first = plan_.groups[static_cast<std::size_t>(frame.groups.front())];
      SceneFrame& into = c_.scene.frames[i];
      if (frame.reused) {
        into.surfaces = first.surfaces;
        into.object_of_surface = first.object_of_surface;
        into.left_out = first.left_out;
        c_.scene.counts.surfaces_reused += first.object_of_surface.size();
        continue;
      }
      frame.builder->surfaces.build();
      into.surfaces = std::make_shared<const SurfaceSet>(std::move(frame.builder->surfaces));
      into.object_of_surface = std::move(frame.builder->object_of_surface);
      into.left_out = std::move(frame.builder->left_out);
      frame.builder.reset();
      c_.scene.counts.surfaces_made += into.object_of_surface.size();
      if (c_.parts.kept && can_be_reused(frame)) {
        first.others.assign(frame.groups.begin() + 1, frame.groups.end());
        first.surfaces = into.surfaces;
        first.object_of_surface = into.object_of_surface;
        first.left_out = into.left_out;
      }
    }
  }

  [[nodiscard]] bool can_be_reused(const FrameOfImage& frame) const {
    return std::none_of(frame.groups.begin(), frame.groups.end(),
                        [&](int group) { return plan_.groups[static_cast<std::size_t>(group)].changes; });
  }

  Compilation& c_;
  const NodeArray& written_;
  ObjectPlan& plan_;
  Materials materials_;
  std::vector<Object> objects_;
  std::vector<std::size_t> frame_of_group_;
  std::vector<bool> moves_;  // by group: whether it has a frame of its own
  std::vector<FrameOfImage> frames_;
  bool is_any_glass_ = true;  // else such surfaces are left out: nothing would show of them
};

}  // namespace

void compile_objects(Compilation& c) {
  static const NodeArray none;
  const Entry* objects = find(c.values.description.root, "object");
  const NodeArray* written = objects != nullptr ? objects->node.array() : nullptr;
  ObjectCompiler(c, written != nullptr ? *written : none).run();
}

}  // namespace backlight
