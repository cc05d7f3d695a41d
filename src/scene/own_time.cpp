#include "own_time.h"

#include "backlight/expression/compose.h"

namespace backlight {
namespace {

// Which parameters are formulas in it, if through others: by index into Description::variables.
std::vector<bool> inserted_parameters(const Description& description, const Expression& expression,
                                      const std::vector<const Entry*>& parameters, std::size_t coordinates) {
  std::vector<bool> inserted(description.variables.size(), false);
  const auto note = [&](const Expression& user, std::size_t before) {
    for (const std::size_t i : user.used_variables()) {
      if (i >= before) inserted[i - before] = inserted[i - before] || description.follows_t[i - before];
    }
  };
  note(expression, coordinates);
  const auto& order = description.parameter_order;
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    if (inserted[*i]) note(std::get<Expression>(parameters[*i]->node.value), 0);
  }
  return inserted;
}

}  // namespace

Expression in_own_time(const ImageValues& values, const Expression& expression) {
  const Description& description = values.description;
  const std::size_t coordinates = expression.variables() - description.variables.size();
  const std::vector<const Entry*> parameters = description.parameters();
  const std::vector<bool> inserted = inserted_parameters(description, expression, parameters, coordinates);
  Composer composer(coordinates + 1);
  std::vector<Composer::Node> nodes;
  for (std::size_t i = 0; i <= coordinates; ++i) nodes.push_back(composer.variable(i));
  for (std::size_t i = variable_t + 1; i < values.variables.size(); ++i)
    nodes.push_back(composer.constant(values.variables[i]));
  const std::span<Composer::Node> own = std::span(nodes).subspan(coordinates);  // from t on
  for (const std::size_t i : description.parameter_order) {
    if (inserted[i]) own[i] = composer.insert(std::get<Expression>(parameters[i]->node.value), own);
  }
  return composer.expression(composer.insert(expression, nodes), expression.text());
}

Expression constant_formula(double value) {
  Composer composer(1);
  return composer.expression(composer.constant(value), number_text(value));
}

}  // namespace backlight
