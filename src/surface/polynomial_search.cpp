// The search for the first roots along many lines on which the formula is a polynomial of low degree.
//
// The tape is run once for each line, in the arithmetic of polynomials with a bound of all rounding
// (expression/line_polynomials.h); where their roots are is found without it (polynomial_lanes.h). The places
// are settled by Newton's steps of the formula itself.

#include <algorithm>
#include <cmath>
#include <vector>

#include "backlight/base/thread_memory.h"
#include "root_searches.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

constexpr std::size_t window = LinePolynomials::most;

/// Work memory of one thread, used again for every search.
struct Memory {
  LineBatch lines{window};
  std::vector<double> workspace;
  PolynomialQuestions questions;
  std::vector<std::size_t> piece_of;  ///< for each line, the index of its piece
  std::vector<std::size_t> hidden;    ///< lines at whose beginning rounding hides the sign
  std::vector<LinePiece> hidden_pieces;
  std::vector<int> signs;
  std::vector<Settling> settling;
  std::vector<std::size_t> undecided;
  std::vector<LinePiece> undecided_pieces;
  std::vector<Root> undecided_roots;
};

Memory& memory_of_thread() {
  static constinit thread_local ThreadMemory<Memory> memory;
  return memory.get();
}

class PolynomialSearch {
 public:
  PolynomialSearch(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                   RootsWanted wanted, RootWork& work)
      : f_(f),
        program_(f.program()),
        kernels_(surface_kernels().polynomials(*f.program().degree())),
        pieces_(pieces),
        roots_(roots),
        existence_(wanted == RootsWanted::existence),
        work_(work),
        m_(memory_of_thread()) {}

  void run() {
    m_.undecided.clear();
    m_.piece_of.clear();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      roots_[i] = no_root();
      if (pieces_[i].from == pieces_[i].to) m_.undecided.push_back(i);
      if (!(pieces_[i].from < pieces_[i].to)) continue;
      const LinePiece& piece = pieces_[i];
      m_.lines.put(m_.piece_of.size(), piece.origin, piece.direction, piece.from, piece.to);
      m_.piece_of.push_back(i);
      if (m_.piece_of.size() == window) search_some();
    }
    search_some();
    search_undecided();
  }

 private:
  void search_some() {
    const std::size_t count = m_.piece_of.size();
    if (count == 0) return;
    const std::size_t padded = (count + LineBatch::padding - 1) / LineBatch::padding * LineBatch::padding;
    program_.polynomials(m_.lines, count, m_.workspace, m_.questions.polynomials);
    work_.polynomials += count;
    kernels_.find_signs(m_.questions, padded);
    find_hidden_signs(count);
    for (std::size_t k = count; k < padded; ++k) m_.questions.sign[k] = m_.questions.sign[count - 1];
    kernels_.find_roots(m_.questions, padded, existence_);
    take(count);
    // Newton's steps of the formula itself: the polynomials have led so near that it takes one, mostly.
    settle_roots(program_, pieces_, m_.settling, roots_, work_);
    m_.piece_of.clear();
  }

  /// Where a line begins next to the surface, the formula itself is asked for the sign there.
  void find_hidden_signs(std::size_t count) {
    m_.hidden.clear();
    m_.hidden_pieces.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const LinePiece& piece = pieces_[m_.piece_of[k]];
      if (piece.sign != 0) m_.questions.sign[k] = piece.sign;
      if (m_.questions.sign[k] != 0.0) continue;
      m_.hidden.push_back(k);
      m_.hidden_pieces.push_back(piece);
    }
    m_.signs.resize(m_.hidden.size());
    find_signs(f_, m_.hidden_pieces, m_.signs);
    work_.points += m_.hidden.size();
    for (std::size_t i = 0; i < m_.hidden.size(); ++i) m_.questions.sign[m_.hidden[i]] = m_.signs[i];
  }

  void take(std::size_t count) {
    const PolynomialQuestions& q = m_.questions;
    m_.settling.clear();
    for (std::size_t k = 0; k < count; ++k) {
      work_.parts += static_cast<std::size_t>(q.pieces[k]);
      const std::size_t i = m_.piece_of[k];
      if (q.verdict[k] == PolynomialQuestions::undecided) m_.undecided.push_back(i);
      if (q.verdict[k] != PolynomialQuestions::crossing) continue;
      const int sign = q.sign[k] > 0.0 ? 1 : -1;
      const LinePiece& piece = pieces_[i];
      roots_[i] = {piece.to, RootKind::crossing, sign, -sign, piece.from, piece.to};
      if (!existence_) begin_settling(i, k);
    }
  }

  void begin_settling(std::size_t i, std::size_t k) {
    const PolynomialQuestions& q = m_.questions;
    const LinePiece& piece = pieces_[i];
    const double half = q.polynomials.half[k];
    const double least = least_length(piece);
    const auto place = [&](double at) { return piece.from + half * (1.0 + at); };
    Root& root = roots_[i];
    root.lower = std::max(piece.from, place(q.low[k]) - least);
    root.upper = std::min(piece.to, place(q.high[k]));
    root.t = std::clamp(place(q.at[k]), root.lower, root.upper);
    m_.settling.push_back({i, 2.0 * q.bend[k] / half});
  }

  void search_undecided() {
    if (m_.undecided.empty()) return;
    m_.undecided_pieces.clear();
    for (const std::size_t i : m_.undecided) m_.undecided_pieces.push_back(pieces_[i]);
    m_.undecided_roots.resize(m_.undecided.size());
    search_by_forms(f_, m_.undecided_pieces, m_.undecided_roots,
                    existence_ ? RootsWanted::existence : RootsWanted::places, work_);
    for (std::size_t k = 0; k < m_.undecided.size(); ++k) roots_[m_.undecided[k]] = m_.undecided_roots[k];
  }

  const ImplicitFormula& f_;
  const LineProgram& program_;
  PolynomialKernels kernels_;
  std::span<const LinePiece> pieces_;
  std::span<Root> roots_;
  bool existence_;
  RootWork& work_;
  Memory& m_;
};

}  // namespace

void search_polynomials(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                        RootsWanted wanted, RootWork& work) {
  PolynomialSearch(f, pieces, roots, wanted, work).run();
}

}  // namespace backlight
