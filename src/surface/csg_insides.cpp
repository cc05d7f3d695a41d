#include "csg_insides.h"

namespace backlight {

void Insides::begin(const Solid& solid) {
  solid_ = &solid;
  leaves_.assign(solid.leaves().size(), Inside::no);
  tallies_.assign(solid.nodes().size(), {});
  whole_ = Inside::no;
}

void Insides::set(int leaf, Inside inside) {
  Inside before = leaves_[index(leaf)];
  Inside now = inside;
  leaves_[index(leaf)] = inside;
  bool first = solid_->leaves()[index(leaf)].first;
  for (int node = solid_->leaves()[index(leaf)].parent; node >= 0 && before != now;) {
    const Solid::Node& operation = solid_->nodes()[index(node)];
    const Inside old = value(node);
    if (first && operation.operation == SolidOperation::difference) {
      tallies_[index(node)].first = now;
    } else {
      count(node, before, -1);
      count(node, now, 1);
    }
    before = old;
    now = value(node);
    first = operation.first;
    node = operation.parent;
    if (node < 0) whole_ = now;
  }
}

void Insides::count(int node, Inside part, int by) {
  Tally& of = tallies_[index(node)];
  if (part == Inside::yes) of.yes += by;
  if (part == Inside::unknown) of.unknown += by;
}

Inside Insides::value(int node) const {
  const Tally& of = tallies_[index(node)];
  const Solid::Node& operation = solid_->nodes()[index(node)];
  switch (operation.operation) {
    case SolidOperation::unite:
      if (of.yes > 0) return Inside::yes;
      return of.unknown > 0 ? Inside::unknown : Inside::no;
    case SolidOperation::intersect:
      if (of.yes + of.unknown < operation.parts) return Inside::no;
      return of.unknown > 0 ? Inside::unknown : Inside::yes;
    case SolidOperation::difference:
      break;
  }
  if (of.first == Inside::no || of.yes > 0) return Inside::no;
  return of.unknown > 0 ? Inside::unknown : of.first;
}

int Insides::decisive(const std::vector<int>& unknown) const {
  for (const int leaf : unknown) {
    int node = solid_->leaves()[index(leaf)].parent;
    while (node >= 0 && value(node) == Inside::unknown) node = solid_->nodes()[index(node)].parent;
    if (node < 0) return leaf;
  }
  return -1;
}

}  // namespace backlight
