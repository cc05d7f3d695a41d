// The search for the first roots along many lines by reduced affine forms (expression/affine.h).
//
// A form over a piece of the line says where in it zeros can be, and the sign of f before and behind. So most
// pieces are left behind whole or for the greatest part without looking at any point, and a simple root is
// enclosed closer and closer. Whether it is one, bounds on the slope say, over the little that is left.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "root_searches.h"

#include "backlight/base/thread_memory.h"

namespace backlight {
namespace {

/// How many lines are searched side by side.
constexpr std::size_t window = 64;

/// The first piece is this part of the whole; the next one is so much longer than one without zeros. Chosen
/// by counting forms on surfaces of degree 2 to 12 and the gyroid.
constexpr double first_part = 0.25;
constexpr double growth = 1.5;
/// Of a piece that is left in part, so much: go on with one as long; less: with half of it.
constexpr double good_part = 0.5;
/// Zeros confined to less than this part of a piece are asked for their slope, to more: for another form.
constexpr double close_part = 0.5;

/// A line on which f has no form over this part of it is RootWalk's.
constexpr double coarsest = 0x1p-7;

/// A line on its way: everything before `begin` is without roots.
struct Traveller {
  std::size_t piece;
  double begin, end;
  double limit;   ///< the end of the line
  double least;   ///< pieces are not made shorter
  double coarse;  ///< nor those without a form made shorter than half of this
  int steps = 0;
};

/// Of a piece that ends at `end`, zeros can only be in [begin, end] of the traveller; behind it the sign of f
/// is certain, as it is before it if `sign_before` is not 0.
struct Bracket {
  Traveller line;
  int sign_before, sign_after;
  double end;     ///< of the piece
  double length;  ///< of the piece
};

/// Work memory of one thread, used again for every search.
struct Memory {
  LineBatch march{window}, settle{window};
  std::vector<double> workspace;
  std::vector<Traveller> on_the_way;  ///< in the order of the batch `march`
  std::vector<Traveller> waiting;
  std::vector<Bracket> brackets;
  std::vector<Bracket> settling;
  std::vector<Bracket> undecided;
  std::vector<Settling> enclosed;  ///< roots
};

Memory& memory_of_thread() {
  static constinit thread_local ThreadMemory<Memory> memory;
  return memory.get();
}

class FormSearch {
 public:
  FormSearch(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
             RootsWanted wanted, RootWork& work)
      : program_(f.program()),
        pieces_(pieces),
        roots_(roots),
        wanted_(wanted),
        work_(work),
        m_(memory_of_thread()),
        most_steps_(most_pieces(work)) {}

  void run() {
    m_.on_the_way.clear();
    m_.waiting.clear();
    m_.brackets.clear();
    m_.enclosed.clear();
    while (true) {
      while (m_.on_the_way.size() < window && start_next(m_.on_the_way.size())) {
      }
      if (m_.on_the_way.empty() && m_.brackets.empty()) break;
      if (m_.on_the_way.empty() || m_.brackets.size() >= window) {
        settle();
        continue;
      }
      march();
    }
    if (wanted_ == RootsWanted::places) settle_roots(program_, pieces_, m_.enclosed, roots_, work_);
  }

 private:
  void put_on(LineBatch& batch, std::size_t slot, const Traveller& line) {
    const LinePiece& piece = pieces_[line.piece];
    batch.put(slot, piece.origin, piece.direction, line.begin, line.end);
  }

  [[nodiscard]] Traveller traveller(std::size_t i) const {
    const LinePiece& piece = pieces_[i];
    return {i,        piece.from,          piece.from + first_part * (piece.to - piece.from),
            piece.to, least_length(piece), coarsest * (piece.to - piece.from)};
  }

  /// Puts the next line that there is into a slot.
  bool start_next(std::size_t slot) {
    Traveller line{};
    if (!m_.waiting.empty()) {
      line = m_.waiting.back();
      m_.waiting.pop_back();
    } else {
      do {
        if (next_ == pieces_.size()) return false;
        line = traveller(next_++);
        roots_[line.piece] = no_root();
        if (line.begin == line.limit) give_up(line.piece);
      } while (!(line.begin < line.limit));
    }
    put_on(m_.march, slot, line);
    if (slot == m_.on_the_way.size()) {
      m_.on_the_way.push_back(line);
    } else {
      m_.on_the_way[slot] = line;
    }
    return true;
  }

  /// False, as the line needs no more forms.
  bool give_up(std::size_t i) {
    roots_[i] = given_up();
    return false;
  }

  /// What a form over a line's piece said.
  struct Answer {
    double first, last, sign, continuity;
  };

  /// One form for each line on its way. From the last to the first, so that what takes a free slot has been
  /// looked at.
  void march() {
    const std::size_t count = m_.on_the_way.size();
    LineBatch& batch = m_.march;
    program_.enclose_zeros(batch, count, m_.workspace);
    work_.forms += count;
    double* const from = batch.from();
    double* const to = batch.to();
    const double* const first = batch.first_zero();
    const double* const last = batch.last_zero();
    const double* const sign = batch.sign();
    const double* const continuity = batch.continuity();
    Traveller* const lines = m_.on_the_way.data();
    for (std::size_t k = count; k-- > 0;) {
      if (step(lines[k], {first[k], last[k], sign[k], continuity[k]})) {
        from[k] = lines[k].begin;
        to[k] = lines[k].end;
      } else if (!start_next(k)) {
        lines[k] = m_.on_the_way.back();
        m_.on_the_way.pop_back();
        if (k < m_.on_the_way.size()) put_on(batch, k, lines[k]);
      }
    }
  }

  /// False: the line needs no more forms, for now or for ever.
  bool step(Traveller& line, const Answer& zeros) {
    const double length = line.end - line.begin;
    if (zeros.first > zeros.last && zeros.continuity == 0.0 && ++line.steps <= most_steps_) {
      return advance(line, line.end, growth * length);
    }
    if (line.steps > most_steps_ || ++line.steps > most_steps_) return give_up(line.piece);
    if (zeros.continuity != 0.0) {
      ++work_.without_form;
      // There may be a form of half the piece.
      return length > line.coarse ? shorten(line, line.begin, 0.5 * length) : give_up(line.piece);
    }
    if (!(zeros.last < line.end)) {
      const double left = zeros.first - line.begin;
      return shorten(line, zeros.first, left > good_part * length ? length : 0.5 * length);
    }
    const double room = zeros.last - zeros.first;
    if (room > close_part * length) return shorten(line, zeros.first, 0.5 * room);
    const int sign = zeros.sign > 0.0 ? 1 : -1;
    const LinePiece& piece = pieces_[line.piece];
    const int sign_at_begin = line.begin == piece.from ? piece.sign : 0;
    Bracket bracket{line, zeros.first > line.begin ? sign : sign_at_begin, -sign, line.end, length};
    bracket.line.begin = zeros.first;
    bracket.line.end = zeros.last;
    m_.brackets.push_back(bracket);
    return false;
  }

  static bool advance(Traveller& line, double to, double length) {
    line.begin = to;
    line.end = to + length;
    if (!(line.end + 0.25 * length < line.limit)) line.end = line.limit;
    return line.begin < line.limit;
  }

  bool shorten(Traveller& line, double begin, double length) {
    return length > line.least ? advance(line, begin, length) : give_up(line.piece);
  }

  void wait(Traveller line, double begin, double length) {
    if (shorten(line, begin, length)) m_.waiting.push_back(line);
  }

  /// Looks closer at the brackets that have come together.
  void settle() {
    const std::size_t count = std::min(window, m_.brackets.size());
    m_.settling.assign(m_.brackets.end() - static_cast<std::ptrdiff_t>(count), m_.brackets.end());
    m_.brackets.resize(m_.brackets.size() - count);
    find_slopes();
    find_signs();
    find_roots();
  }

  /// Keeps those over which f is monotone.
  void find_slopes() {
    const std::size_t count = m_.settling.size();
    for (std::size_t k = 0; k < count; ++k) put_on(m_.settle, k, m_.settling[k].line);
    program_.enclose_pieces(m_.settle, count, m_.workspace);
    work_.cells += count;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Bracket& b = m_.settling[k];
      const bool monotone = m_.settle.slope_lower()[k] > 0.0 || m_.settle.slope_upper()[k] < 0.0;
      if (monotone && m_.settle.continuity()[k] == 0.0) {
        m_.settling[kept++] = b;
      } else {
        wait(b.line, b.line.begin, 0.5 * (b.line.end - b.line.begin));
      }
    }
    m_.settling.resize(kept);
  }

  /// Where the sign before the bracket is not known yet, it is looked at.
  void find_signs() {
    m_.undecided.clear();
    std::size_t kept = 0;
    for (Bracket& b : m_.settling) {
      if (b.sign_before == 0) {
        put_on(m_.settle, m_.undecided.size(), b.line);
        m_.undecided.push_back(b);
      } else if (has_root(b)) {
        m_.settling[kept++] = b;
      }
    }
    m_.settling.resize(kept);
    program_.enclose_points(m_.settle, m_.undecided.size(), m_.workspace);
    work_.points += m_.undecided.size();
    for (std::size_t k = 0; k < m_.undecided.size(); ++k) {
      Bracket& b = m_.undecided[k];
      b.sign_before = m_.settle.certain_sign(k);
      if (b.sign_before == 0) {
        give_up(b.line.piece);
      } else if (has_root(b)) {
        m_.settling.push_back(b);
      }
    }
  }

  /// Whether there is a root in a bracket over which f is monotone; else the line goes on behind it.
  bool has_root(Bracket& b) {
    if (b.sign_before != b.sign_after) return true;
    if (advance(b.line, b.end, growth * b.length)) m_.waiting.push_back(b.line);
    return false;
  }

  void find_roots() {
    for (const Bracket& b : m_.settling) {
      const double middle = 0.5 * b.line.begin + 0.5 * b.line.end;
      roots_[b.line.piece] = {middle,       RootKind::crossing, b.sign_before,
                              b.sign_after, b.line.begin,       b.line.end};
      m_.enclosed.push_back({b.line.piece});
    }
  }

  const LineProgram& program_;
  std::span<const LinePiece> pieces_;
  std::span<Root> roots_;
  RootsWanted wanted_;
  RootWork& work_;
  Memory& m_;
  int most_steps_;
  std::size_t next_ = 0;
};

}  // namespace

void search_by_forms(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                     RootsWanted wanted, RootWork& work) {
  FormSearch(f, pieces, roots, wanted, work).run();
}

}  // namespace backlight
