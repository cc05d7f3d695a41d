#include "csg_insides.h"

namespace backlight {

void Insides::begin(const Solid& solid) {
  solid_ = &solid;
  leaf_inside_.assign(solid.leaves().size(), 0);
  unknown_.assign(solid.leaves().size(), 0);
  count_.assign(solid.nodes().size(), 0);
  first_inside_.assign(solid.nodes().size(), 0);
  whole_ = false;
}

void Insides::toggle(int leaf) {
  const Solid::Leaf& part = solid_->leaves()[index(leaf)];
  char& inside = leaf_inside_[index(leaf)];
  inside = inside == 0 ? 1 : 0;
  bool now = inside != 0;
  bool first = part.first;
  for (int node = part.parent; node >= 0;) {
    const bool before = value(node);
    set_part(node, first, now);
    const bool after = value(node);
    if (before == after) return;
    const Solid::Node& operation = solid_->nodes()[index(node)];
    now = after;
    first = operation.first;
    node = operation.parent;
  }
  whole_ = now;
}

bool Insides::value(int node) const {
  const std::size_t i = index(node);
  switch (solid_->nodes()[i].operation) {
    case SolidOperation::unite:
      return count_[i] > 0;
    case SolidOperation::intersect:
      return count_[i] == solid_->nodes()[i].parts;
    case SolidOperation::difference:
      break;
  }
  return first_inside_[i] != 0 && count_[i] == 0;
}

void Insides::set_part(int node, bool first, bool inside) {
  const std::size_t i = index(node);
  if (first && solid_->nodes()[i].operation == SolidOperation::difference) {
    first_inside_[i] = inside ? 1 : 0;
  } else {
    count_[i] += inside ? 1 : -1;
  }
}

void Insides::tally(int node, bool first, Truth part) {
  Tally& of = tallies_[index(node)];
  if (first && solid_->nodes()[index(node)].operation == SolidOperation::difference) {
    of.first = part;
  } else {
    of.yes += part == Truth::yes ? 1 : 0;
    of.unknown += part == Truth::unknown ? 1 : 0;
  }
}

Insides::Truth Insides::value_of(int node) const {
  const Tally& of = tallies_[index(node)];
  const Solid::Node& operation = solid_->nodes()[index(node)];
  switch (operation.operation) {
    case SolidOperation::unite:
      if (of.yes > 0) return Truth::yes;
      return of.unknown > 0 ? Truth::unknown : Truth::no;
    case SolidOperation::intersect:
      if (of.yes + of.unknown < operation.parts) return Truth::no;
      return of.unknown > 0 ? Truth::unknown : Truth::yes;
    case SolidOperation::difference:
      break;
  }
  if (of.first == Truth::no || of.yes > 0) return Truth::no;
  return of.unknown > 0 ? Truth::unknown : of.first;
}

int Insides::decisive(const std::vector<int>& unknown) {
  if (unknown.empty()) return -1;
  const std::vector<Solid::Leaf>& leaves = solid_->leaves();
  const std::vector<Solid::Node>& nodes = solid_->nodes();
  tallies_.assign(nodes.size(), {});
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Truth inside = leaf_inside_[i] != 0 ? Truth::yes : Truth::no;
    tally(leaves[i].parent, leaves[i].first, unknown_[i] != 0 ? Truth::unknown : inside);
  }
  for (std::size_t i = nodes.size(); i-- > 0;) {  // parts come behind what they are part of
    tallies_[i].value = value_of(static_cast<int>(i));
    if (nodes[i].parent >= 0) tally(nodes[i].parent, nodes[i].first, tallies_[i].value);
  }
  for (const int leaf : unknown) {
    int node = leaves[index(leaf)].parent;
    while (node >= 0 && tallies_[index(node)].value == Truth::unknown) node = nodes[index(node)].parent;
    if (node < 0) return leaf;
  }
  return -1;
}

}  // namespace backlight
