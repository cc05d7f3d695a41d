#include "csg_sheet.h"

#include <algorithm>
#include <tuple>

#include "backlight/base/thread_memory.h"
#include "root_searches.h"

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

}  // namespace

void first_of_solid(const Solid& solid, const LocalLines& lines, double lambda_min,
                    std::span<Sweep::Event> first) {
  Memory& m = memory_of_thread();
  m.going.clear();
  for (std::size_t i = 0; i < lines.count; ++i) {
    m.sweeps[i].begin(solid, lines.line(i), lambda_min);
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
