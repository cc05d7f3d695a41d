#include "polynomial_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "affine_search.h"
#include "newton_bracket.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

constexpr std::size_t window = LinePolynomials::most;

/// A root on its way to full precision.
struct Settling {
  std::size_t piece;
  NewtonBracket bracket;
};

/// Work memory of one thread, used again for every search.
struct Memory {
  LineBatch lines{window};
  LineBatch points{window};
  std::vector<double> workspace;
  PolynomialQuestions questions;
  std::vector<std::size_t> piece_of;  ///< for each line, the index of its piece
  std::vector<std::size_t> asking;
  std::vector<Settling> settling;
  std::vector<std::size_t> undecided;
  std::vector<LinePiece> undecided_pieces;
  std::vector<Root> undecided_roots;
};

Memory& memory_of_thread() {
  thread_local Memory memory;
  return memory;
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
      put_on(m_.lines, m_.piece_of.size(), pieces_[i], pieces_[i].from, pieces_[i].to);
      m_.piece_of.push_back(i);
      if (m_.piece_of.size() == window) search_some();
    }
    search_some();
    search_undecided();
  }

 private:
  static void put_on(LineBatch& batch, std::size_t slot, const FormulaLine& line, double from, double to) {
    for (std::size_t v = 0; v < ImplicitFormula::variables; ++v) {
      batch.origin(v)[slot] = line.origin[v];
      batch.direction(v)[slot] = line.direction[v];
    }
    batch.from()[slot] = from;
    batch.to()[slot] = to;
  }

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
    settle();
    m_.piece_of.clear();
  }

  /// Where a line begins next to the surface, the formula itself is asked for the sign there.
  void find_hidden_signs(std::size_t count) {
    m_.asking.clear();
    for (std::size_t k = 0; k < count; ++k) {
      if (m_.questions.sign[k] != 0.0) continue;
      const LinePiece& piece = pieces_[m_.piece_of[k]];
      put_on(m_.points, m_.asking.size(), piece, piece.from, piece.from);
      m_.asking.push_back(k);
    }
    program_.enclose_points(m_.points, m_.asking.size(), m_.workspace);
    work_.points += m_.asking.size();
    for (std::size_t i = 0; i < m_.asking.size(); ++i) {
      const double sign = m_.points.lower()[i] > 0.0 ? 1.0 : m_.points.upper()[i] < 0.0 ? -1.0 : 0.0;
      m_.questions.sign[m_.asking[i]] = m_.points.continuity()[i] == 0.0 ? sign : 0.0;
    }
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
    double size = std::max(std::abs(piece.from), std::abs(piece.to));
    for (std::size_t v = 0; v < 3; ++v) size = std::max(size, std::abs(piece.origin[v]));
    const double least = 16.0 * std::numeric_limits<double>::epsilon() * size;
    const auto place = [&](double at) { return piece.from + half * (1.0 + at); };
    Root& root = roots_[i];
    root.lower = std::max(piece.from, place(q.low[k]) - least);
    root.upper = std::min(piece.to, place(q.high[k]) + least);
    root.t = std::clamp(place(q.at[k]), root.lower, root.upper);
    put_on(m_.points, m_.settling.size(), piece, root.t, root.t);
    m_.settling.push_back({i, {root.lower, root.upper, root.sign_before > 0, least, 2.0 * q.bend[k] / half}});
  }

  /// Newton's steps of the formula itself: the polynomials have led so near that it takes one, mostly.
  void settle() {
    double* const at = m_.points.from();
    while (!m_.settling.empty()) {
      const std::size_t count = m_.settling.size();
      program_.numbers(m_.points, count, m_.workspace);
      work_.polish += count;
      std::size_t kept = 0;
      for (std::size_t k = 0; k < count; ++k) {
        Settling s = m_.settling[k];
        double t = at[k];
        const bool settled = s.bracket.improve(t, m_.points.value()[k], m_.points.slope()[k]);
        roots_[s.piece].t = t;
        if (settled) continue;
        put_on(m_.points, kept, pieces_[s.piece], t, t);
        m_.settling[kept++] = s;
      }
      m_.settling.resize(kept);
    }
  }

  void search_undecided() {
    if (m_.undecided.empty()) return;
    m_.undecided_pieces.clear();
    for (const std::size_t i : m_.undecided) m_.undecided_pieces.push_back(pieces_[i]);
    m_.undecided_roots.resize(m_.undecided.size());
    first_roots_by_forms(f_, m_.undecided_pieces, m_.undecided_roots,
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

void first_roots_of_polynomials(const ImplicitFormula& f, std::span<const LinePiece> pieces,
                                std::span<Root> roots, RootsWanted wanted, RootWork& work) {
  PolynomialSearch(f, pieces, roots, wanted, work).run();
}

}  // namespace backlight
