"""The numbers of a scene file: literals as the exact doubles they are, strings as expressions.

Expressions are evaluated in double precision by walking Python's syntax tree over a closed list
of operators and functions, so no scene can run code.
"""
import ast
import math
import operator

from mpmath import mp, mpf

FUNCTIONS = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan,
    "asin": math.asin, "acos": math.acos, "atan": math.atan, "atan2": math.atan2,
    "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh,
    "exp": math.exp, "log": math.log, "sqrt": math.sqrt,
    "cbrt": lambda x: math.copysign(abs(x) ** (1.0 / 3.0), x),
    "abs": abs, "floor": math.floor, "min": min, "max": max, "pow": math.pow, "mod": math.fmod,
    "clamp": lambda x, low, high: min(max(x, low), high),
}
CONSTANTS = {"pi": math.pi, "e": math.e}
BINARY = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul,
          ast.Div: operator.truediv, ast.Pow: operator.pow}
UNARY = {ast.UAdd: operator.pos, ast.USub: operator.neg}

# The same functions at 60 digits, for the clock of a flickering lamp: its argument is not a double.
PRECISE = {name: getattr(mp, name) for name in
           ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
            "exp", "log", "sqrt", "cbrt", "floor")}
PRECISE |= {"abs": abs, "min": min, "max": max, "pow": lambda x, y: mpf(x) ** y,
            "mod": lambda x, y: x - y * (mp.floor(x / y) if x / y >= 0 else mp.ceil(x / y)),
            "clamp": FUNCTIONS["clamp"]}


def _value(node, variables, functions):
    """The value of a syntax tree; ValueError for anything outside the language."""
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return float(node.value) if functions is FUNCTIONS else mpf(float(node.value))
    if isinstance(node, ast.Name):
        if node.id not in variables:
            raise ValueError(f"unknown variable '{node.id}'")
        return variables[node.id]
    if isinstance(node, ast.BinOp) and type(node.op) in BINARY:
        left, right = (_value(side, variables, functions) for side in (node.left, node.right))
        return BINARY[type(node.op)](left, right)
    if isinstance(node, ast.UnaryOp) and type(node.op) in UNARY:
        return UNARY[type(node.op)](_value(node.operand, variables, functions))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in functions:
        return functions[node.func.id](*[_value(a, variables, functions) for a in node.args])
    raise ValueError("not an expression of the scene language")


def evaluate(text, variables):
    """The double value of an expression text."""
    tree = ast.parse(text.strip().replace("^", "**"), mode="eval").body
    return float(_value(tree, CONSTANTS | variables, FUNCTIONS))


def evaluate_precisely(text, variables):
    """The 60-digit value of an expression text, its literals being doubles."""
    tree = ast.parse(text.strip().replace("^", "**"), mode="eval").body
    return mpf(_value(tree, {"pi": +mp.pi, "e": +mp.e} | variables, PRECISE))


def number(value, variables):
    """A scene number, literal or expression, as an mpf."""
    return mpf(evaluate(value, variables)) if isinstance(value, str) else mpf(value)


def vector(values, variables):
    """A list of scene numbers as a list of mpf."""
    return [number(value, variables) for value in values]


class _Literals(ast.NodeTransformer):
    """Literals as the doubles that they are, in some arithmetic."""

    def visit_Constant(self, node):
        return ast.copy_location(ast.Call(ast.Name("_real", ast.Load()), [ast.Constant(float(node.value))], []), node)


def compiled(value, variables, kind, of=("t",)):
    """A number as written, as a function of `of` in the arithmetic `kind` (real, functions, constants)."""
    if not isinstance(value, str):
        number = kind.real(value)
        return lambda *_: number
    tree = ast.parse(value.strip().replace("^", "**"), mode="eval")
    _value(tree.body, CONSTANTS | {k: 1.0 for k in variables} | {k: 0.5 for k in of}, FUNCTIONS)  # refuses all else
    code = compile(ast.fix_missing_locations(_Literals().visit(tree)), "formula", "eval")
    names = kind.functions | kind.constants | variables | {"_real": kind.real, "__builtins__": {}}
    return lambda *values: eval(code, names | dict(zip(of, values)))
