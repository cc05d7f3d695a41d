// The first roots of a formula along many lines: their searches side by side, the tape run once for all that
// ask the same.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "backlight/base/thread_memory.h"
#include "line_search.h"
#include "newton_bracket.h"
#include "root_searches.h"

namespace backlight {
namespace {

/// How many lines are searched side by side.
constexpr std::size_t window = 64;

/// Work memory of one thread, used again for every search.
struct Memory {
  LineBatch batch{window};
  std::vector<double> workspace;
  std::vector<LineSearch> searches;   ///< side by side, at most `window`
  std::vector<std::size_t> piece_of;  ///< for each search, the index of its piece
  std::vector<std::size_t> live;      ///< the searches that are not finished
  std::vector<std::size_t> asking;    ///< those that ask what is to be answered next
  std::vector<Settling> settling;     ///< the roots that were enclosed
  std::vector<NewtonBracket> newton;
};

Memory& memory_of_thread() {
  static constinit thread_local ThreadMemory<Memory> memory;
  return memory.get();
}

class SideBySide {
 public:
  SideBySide(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
             RootsWanted wanted, RootWork& work)
      : program_(f.program()),
        pieces_(pieces),
        roots_(roots),
        wanted_(wanted),
        work_(work),
        m_(memory_of_thread()),
        most_pieces_(most_pieces(work)) {}

  void run() {
    next_ = std::min(window, pieces_.size());
    m_.searches.clear();
    m_.piece_of.clear();
    m_.live.clear();
    m_.settling.clear();
    for (std::size_t i = 0; i < next_; ++i) {
      m_.searches.emplace_back(pieces_[i], most_pieces_);
      m_.piece_of.push_back(i);
      m_.live.push_back(i);
    }
    for (drop_finished(); !m_.live.empty(); drop_finished()) {
      answer_pieces();
      answer_points();
    }
    if (wanted_ == RootsWanted::places) settle_roots(program_, pieces_, m_.settling, roots_, work_);
  }

 private:
  /// In the place of a search that is at its end the next line's begins.
  void drop_finished() {
    for (std::size_t k = 0; k < m_.live.size();) {
      const std::size_t i = m_.live[k];
      if (!m_.searches[i].is_finished()) {
        ++k;
        continue;
      }
      report(m_.piece_of[i], m_.searches[i]);
      if (next_ < pieces_.size()) {
        m_.searches[i] = LineSearch(pieces_[next_], most_pieces_);
        m_.piece_of[i] = next_++;
      } else {
        m_.live[k] = m_.live.back();
        m_.live.pop_back();
      }
    }
  }

  void report(std::size_t piece, const LineSearch& search) {
    if (search.has_root()) m_.settling.push_back({piece});
    roots_[piece] = search.has_given_up() ? given_up() : search.has_root() ? search.root() : no_root();
  }

  /// Collects the searches that ask this, each with its line.
  template <class Asks, class From, class To>
  std::size_t collect(const Asks& asks, const From& from, const To& to) {
    m_.asking.clear();
    for (const std::size_t i : m_.live) {
      const LineSearch& search = m_.searches[i];
      if (!asks(search)) continue;
      const LinePiece& piece = search.piece();
      m_.batch.put(m_.asking.size(), piece.origin, piece.direction, from(search), to(search));
      m_.asking.push_back(i);
    }
    return m_.asking.size();
  }

  [[nodiscard]] Interval value(std::size_t k) {
    return {m_.batch.lower()[k], m_.batch.upper()[k], static_cast<Continuity>(m_.batch.continuity()[k])};
  }

  void answer_pieces() {
    const std::size_t count =
        collect([](const LineSearch& s) { return s.asks_piece(); },
                [](const LineSearch& s) { return s.begin(); }, [](const LineSearch& s) { return s.end(); });
    program_.enclose_pieces(m_.batch, count, m_.workspace);
    work_.cells += count;
    for (std::size_t k = 0; k < count; ++k) {
      m_.searches[m_.asking[k]].piece_is(value(k), m_.batch.slope_lower()[k], m_.batch.slope_upper()[k]);
    }
  }

  void answer_points() {
    const auto at = [](const LineSearch& s) { return s.point(); };
    const std::size_t count = collect([](const LineSearch& s) { return s.asks_point(); }, at, at);
    program_.enclose_points(m_.batch, count, m_.workspace);
    work_.points += count;
    for (std::size_t k = 0; k < count; ++k) m_.searches[m_.asking[k]].point_is(value(k));
  }

  const LineProgram& program_;
  std::span<const LinePiece> pieces_;
  std::span<Root> roots_;
  RootsWanted wanted_;
  RootWork& work_;
  Memory& m_;
  int most_pieces_;
  std::size_t next_ = 0;
};

/// The first root on a line that a search gave up.
Root walked_root(const ImplicitFormula& f, const LinePiece& piece, RootWork& work) {
  ++work.given_up;
  if (work.only_count) return no_root();
  RootWalk walk(f, piece);
  Root root;
  const bool any = walk.next(root);
  work.walked += walk.work().cells + walk.work().points + walk.work().polish;
  return any ? root : no_root();
}

}  // namespace

void settle_roots(const LineProgram& program, std::span<const LinePiece> pieces,
                  std::span<const Settling> some, std::span<Root> roots, RootWork& work) {
  Memory& m = memory_of_thread();
  const auto put = [&](std::size_t slot, std::size_t piece) {
    const double t = roots[piece].t;
    m.batch.put(slot, pieces[piece].origin, pieces[piece].direction, t, t);
  };
  for (std::size_t first = 0; first < some.size(); first += window) {
    std::size_t count = std::min(window, some.size() - first);
    m.newton.clear();
    m.piece_of.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [i, bend] = some[first + k];
      put(k, i);
      m.piece_of.push_back(i);
      m.newton.push_back(
          {roots[i].lower, roots[i].upper, roots[i].sign_before > 0, least_length(pieces[i]), bend});
    }
    while (count > 0) {
      program.numbers(m.batch, count, m.workspace);
      work.polish += count;
      std::size_t kept = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = m.piece_of[k];
        if (m.newton[k].improve(roots[i].t, m.batch.value()[k], m.batch.slope()[k])) continue;
        kept == k ? void(m.batch.from()[k] = roots[i].t) : put(kept, i);
        m.newton[kept] = m.newton[k];
        m.piece_of[kept++] = i;
      }
      count = kept;
    }
  }
}

double least_length(const LinePiece& piece) {
  double size = std::max(std::abs(piece.from), std::abs(piece.to));
  for (std::size_t v = 0; v < 3; ++v) size = std::max(size, std::abs(piece.origin[v]));
  return 16.0 * std::numeric_limits<double>::epsilon() * size;
}

void search_roots(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                  RootFinder finder, RootWork& work, RootsWanted wanted) {
  if (finder == RootFinder::polynomial && f.program().degree()) {
    search_polynomials(f, pieces, roots, wanted, work);
  } else if (finder != RootFinder::interval) {
    search_by_forms(f, pieces, roots, wanted, work);
  } else {
    SideBySide(f, pieces, roots, wanted, work).run();
  }
}

void find_signs(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<int> signs) {
  Memory& m = memory_of_thread();
  for (std::size_t first = 0; first < pieces.size(); first += window) {
    const std::size_t count = std::min(window, pieces.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const LinePiece& piece = pieces[first + k];
      m.batch.put(k, piece.origin, piece.direction, piece.from, piece.from);
    }
    f.program().enclose_points(m.batch, count, m.workspace);
    for (std::size_t k = 0; k < count; ++k) signs[first + k] = m.batch.certain_sign(k);
  }
}

void first_roots(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                 RootFinder finder, RootWork* work, RootsWanted wanted) {
  RootWork own;
  RootWork& sum = work != nullptr ? *work : own;
  search_roots(f, pieces, roots, finder, sum, wanted);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (is_given_up(roots[i])) roots[i] = walked_root(f, pieces[i], sum);
  }
}

}  // namespace backlight
