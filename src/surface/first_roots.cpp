// The first roots of a formula along many lines: their searches side by side, the tape run once for all that
// ask the same.
#include <algorithm>
#include <span>

#include "affine_search.h"
#include "line_search.h"
#include "polynomial_search.h"

namespace backlight {
namespace {

constexpr std::size_t variables = ImplicitFormula::variables;

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
};

Memory& memory_of_thread() {
  thread_local Memory memory;
  return memory;
}

class SideBySide {
 public:
  SideBySide(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
             RootsWanted wanted, RootWork& work)
      : f_(f),
        program_(f.program()),
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
    for (std::size_t i = 0; i < next_; ++i) {
      m_.searches.emplace_back(pieces_[i], most_pieces_, wanted_);
      m_.piece_of.push_back(i);
      m_.live.push_back(i);
    }
    for (drop_finished(); !m_.live.empty(); drop_finished()) {
      answer_pieces();
      answer_points();
      answer_numbers();
    }
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
        m_.searches[i] = LineSearch(pieces_[next_], most_pieces_, wanted_);
        m_.piece_of[i] = next_++;
      } else {
        m_.live[k] = m_.live.back();
        m_.live.pop_back();
      }
    }
  }

  void report(std::size_t piece, const LineSearch& search) {
    const LinePiece& p = pieces_[piece];
    if (search.has_given_up()) {
      roots_[piece] = walked_root(f_, p, work_);
    } else {
      roots_[piece] = search.has_root() ? search.root() : no_root();
    }
  }

  /// Collects the searches that ask this, each with its line.
  template <class Asks, class From, class To>
  std::size_t collect(const Asks& asks, const From& from, const To& to) {
    m_.asking.clear();
    for (const std::size_t i : m_.live) {
      const LineSearch& search = m_.searches[i];
      if (!asks(search)) continue;
      const std::size_t k = m_.asking.size();
      for (std::size_t v = 0; v < variables; ++v) {
        m_.batch.origin(v)[k] = search.piece().origin[v];
        m_.batch.direction(v)[k] = search.piece().direction[v];
      }
      m_.batch.from()[k] = from(search);
      m_.batch.to()[k] = to(search);
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

  void answer_numbers() {
    const auto at = [](const LineSearch& s) { return s.point(); };
    const std::size_t count = collect([](const LineSearch& s) { return s.asks_number(); }, at, at);
    program_.numbers(m_.batch, count, m_.workspace);
    work_.polish += count;
    for (std::size_t k = 0; k < count; ++k) {
      m_.searches[m_.asking[k]].number_is(m_.batch.value()[k], m_.batch.slope()[k]);
    }
  }

  const ImplicitFormula& f_;
  const LineProgram& program_;
  std::span<const LinePiece> pieces_;
  std::span<Root> roots_;
  RootsWanted wanted_;
  RootWork& work_;
  Memory& m_;
  int most_pieces_;
  std::size_t next_ = 0;
};

}  // namespace

Root walked_root(const ImplicitFormula& f, const LinePiece& piece, RootWork& work) {
  ++work.given_up;
  if (work.only_count) return no_root();
  RootWalk walk(f, piece, piece.from, piece.to);
  Root root;
  const bool any = walk.next(root);
  work.walked += walk.work().cells + walk.work().points + walk.work().polish;
  return any ? root : no_root();
}

void first_roots(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                 RootFinder finder, RootWork* work, RootsWanted wanted) {
  RootWork own;
  RootWork& sum = work != nullptr ? *work : own;
  if (finder == RootFinder::polynomial && f.program().degree()) {
    first_roots_of_polynomials(f, pieces, roots, wanted, sum);
  } else if (finder != RootFinder::interval) {
    first_roots_by_forms(f, pieces, roots, wanted, sum);
  } else {
    SideBySide(f, pieces, roots, wanted, sum).run();
  }
}

Root first_root(const ImplicitFormula& f, const FormulaLine& line, double from, double to,
                RootFinder finder) {
  const LinePiece piece{line, from, to};
  Root root;
  first_roots(f, {&piece, 1}, {&root, 1}, finder);
  return root;
}

}  // namespace backlight
