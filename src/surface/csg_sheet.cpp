#include "csg_sheet.h"

#include <algorithm>
#include <tuple>

#include "backlight/base/thread_memory.h"
#include "implicit_stretches.h"
#include "root_searches.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

/// Work memory of one thread, used again for every sheet.
struct Memory {
  std::vector<Sweep> sweeps{LocalLines::most};
  std::vector<std::size_t> going;  ///< the lines whose sweeps are not at their end
  std::vector<Sweep*> asking;
  std::vector<LinePiece> pieces;
  std::vector<Root> roots;
  std::vector<int> signs;
  std::vector<LineStretches> stretches, of_group;
  std::vector<const Shape*> shapes;
};

Memory& memory_of_thread() {
  static constinit thread_local ThreadMemory<Memory> memory;
  return memory.get();
}

auto question_of(Sweep* sweep) {
  return std::tuple{sweep->asked_leaf(), sweep->asked().asks()};
}

/// Answers those who ask the same of the same leaf.
void answer(const Shape& shape, std::span<Sweep* const> asking, Memory& m) {
  m.pieces.clear();
  for (Sweep* sweep : asking) m.pieces.push_back(sweep->asked().question());
  if (asking.front()->asked().asks() == SolidWalk::Asks::sign) {
    m.signs.resize(asking.size());
    find_signs(*shape.formula, m.pieces, m.signs);
    for (std::size_t i = 0; i < asking.size(); ++i) asking[i]->asked().sign_is(m.signs[i]);
  } else {
    m.roots.resize(asking.size());
    RootWork work;
    search_roots(*shape.formula, m.pieces, m.roots, root_finder(shape), work);
    for (std::size_t i = 0; i < asking.size(); ++i) asking[i]->asked().root_is(m.roots[i]);
  }
}

void answer_all(const Solid& solid, Memory& m) {
  std::stable_sort(m.asking.begin(), m.asking.end(),
                   [](Sweep* a, Sweep* b) { return question_of(a) < question_of(b); });
  for (auto first = m.asking.begin(); first != m.asking.end();) {
    const auto last = std::find_if(first, m.asking.end(),
                                   [&](Sweep* sweep) { return question_of(sweep) != question_of(*first); });
    const auto leaf = static_cast<std::size_t>((*first)->asked_leaf());
    answer(solid.leaves()[leaf].surface.shape, {first, last}, m);
    first = last;
  }
}

/// Where along the lines of the whole each of the leaves that move can be.
void find_moving(const Solid& solid, const LocalLines& lines, Memory& m) {
  for (const std::vector<int>& group : solid.moving_groups()) {
    LocalLines of_group;
    of_group.count = lines.count;
    for (int k = 0; k < 3; ++k) {
      std::copy_n(lines.point[k], lines.padded(), of_group.origin[k]);
      std::copy_n(lines.direction[k], lines.padded(), of_group.along[k]);
    }
    std::copy_n(lines.clock_start, lines.padded(), of_group.time);
    std::copy_n(lines.clock_rate, lines.padded(), of_group.rate);
    surface_kernels().local_lines(solid.leaves()[static_cast<std::size_t>(group.front())].surface.lanes,
                                  of_group);
    // From the rays' own beginnings, since what light meets depends on where it comes from.
    for (std::size_t i = 0; i < lines.padded(); ++i) {
      const double per_length = lines.lambda_per_length[i];
      of_group.lambda_shift[i] =
          lines.lambda_shift[i] + (of_group.lambda_centre[i] + of_group.lambda_shift[i]) * per_length;
      of_group.lambda_centre[i] = lines.lambda_centre[i];
      of_group.lambda_per_length[i] *= per_length;
    }
    m.shapes.clear();
    for (const int leaf : group)
      m.shapes.push_back(&solid.leaves()[static_cast<std::size_t>(leaf)].surface.shape);
    if (m.stretches.size() < solid.leaves().size()) m.stretches.resize(solid.leaves().size());
    if (m.of_group.size() < group.size()) m.of_group.resize(group.size());
    find_stretches(m.shapes, of_group, {m.of_group.data(), group.size()});
    for (std::size_t g = 0; g < group.size(); ++g)
      m.stretches[static_cast<std::size_t>(group[g])] = m.of_group[g];
  }
}

}  // namespace

void first_of_solid(const Solid& solid, const LocalLines& lines, double lambda_min,
                    std::span<Sweep::Event> first) {
  Memory& m = memory_of_thread();
  m.going.clear();
  find_moving(solid, lines, m);
  for (std::size_t i = 0; i < lines.count; ++i) {
    m.sweeps[i].begin(solid, lines.line(i), lambda_min, {m.stretches.data(), i});
    m.going.push_back(i);
  }
  while (!m.going.empty()) {
    m.asking.clear();
    std::size_t kept = 0;
    for (const std::size_t i : m.going) {
      const Sweep::Found found = m.sweeps[i].first(first[i]);
      if (found == Sweep::Found::nothing) first[i].t = infinite;
      if (found != Sweep::Found::question) continue;
      m.going[kept++] = i;
      m.asking.push_back(&m.sweeps[i]);
    }
    m.going.resize(kept);
    answer_all(solid, m);
  }
}

}  // namespace backlight
