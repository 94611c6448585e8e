"""Deliberate changes of a source file: each turns one operator, number, condition or call into another."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

COMPARE: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.GtE, ast.Gt),
    ast.LtE: (ast.Gt, ast.GtE),
    ast.Gt: (ast.LtE, ast.Lt),
    ast.GtE: (ast.Lt, ast.LtE),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
"""What each comparison becomes: its negation, or the other direction."""

ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
}

SWAPPED = {
    "min": "max",
    "max": "min",
    "any": "all",
    "all": "any",
    "minimum": "maximum",
    "maximum": "minimum",
    "argmin": "argmax",
    "argmax": "argmin",
}
"""Calls that have an opposite."""


@dataclass(frozen=True)
class Change:
    """One change of one file.

    Attributes:
        line: Where it begins, counted from 1.
        end: Where it ends.
        where: Class and function, or an empty text at the top of the file.
        text: The line in which it begins.
        kind: What kind of change it is.
        old: The source before.
        new: The source after.
        node: Place of the changed node in the walk over the tree.
        variant: Which of the changes of that node.
    """

    file: str
    line: int
    end: int
    where: str
    text: str
    kind: str
    old: str
    new: str
    node: int
    variant: int

    @property
    def key(self) -> str:
        """Tells the change, whatever the lines are."""
        return f"{self.file} | {self.where} | {self.text} | {self.old} -> {self.new}"


def changes(file: str, source: str) -> list[Change]:
    """Return every change of a file that there is, in the order of the source."""
    tree, text = ast.parse(source), source.splitlines()
    places = _functions(tree)
    found = []
    for k, node in enumerate(_changeable(tree)):
        for v, (kind, new) in enumerate(_variants(node)):
            old, line, end = ast.unparse(node), node.lineno, node.end_lineno or node.lineno
            if isinstance(node, ast.If):
                old, end = f"if {ast.unparse(node.test)}", node.test.end_lineno or line
            at = _short(text[line - 1])
            found.append(Change(file, line, end, places.get(line, ""), at, kind, _short(old), _short(new[0]), k, v))
    return found


def changed(source: str, change: Change, path: Path) -> ast.Module:
    """Return the tree of a source with one change in it."""
    tree = ast.parse(source, str(path))
    node = list(_changeable(tree))[change.node]
    _, (_, become) = list(_variants(node))[change.variant]
    new = become
    for parent in ast.walk(tree):
        for name, value in ast.iter_fields(parent):
            if value is node:
                setattr(parent, name, new)
            elif isinstance(value, list):
                value[:] = [new if item is node else item for item in value]
    return ast.fix_missing_locations(tree)


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 110 else f"{text[:107]}..."


def _functions(tree: ast.Module) -> dict[int, str]:
    """Return the innermost class and function of each line."""
    names: dict[int, str] = {}

    def enter(node: ast.AST, path: str) -> None:
        for child in ast.iter_child_nodes(node):
            here = path
            if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                here = f"{path}.{child.name}".lstrip(".")
                names.update(dict.fromkeys(range(child.lineno, (child.end_lineno or child.lineno) + 1), here))
            enter(child, here)

    enter(tree, "")
    return names


def _changeable(tree: ast.AST) -> Iterator[ast.expr | ast.stmt]:
    """Yield the nodes that may be changed: no annotations, decorators, texts, imports or assertions."""
    for name, value in ast.iter_fields(tree):
        if name in {"annotation", "returns", "decorator_list", "type_params", "bases", "format_spec"}:
            continue
        for child in value if isinstance(value, list) else [value]:
            if not isinstance(child, ast.AST) or isinstance(child, ast.Import | ast.ImportFrom | ast.Assert):
                continue
            if isinstance(child, ast.Assign) and _is_type(child):
                continue
            if isinstance(child, ast.keyword) and child.arg in {"strict", "dtype", "slots", "frozen"}:
                continue
            if isinstance(child, ast.expr | ast.stmt):
                yield child
            yield from _changeable(child)


def _is_type(node: ast.Assign) -> bool:
    """Whether an assignment only names a type (``Array = NDArray[np.float64]``) or public names."""
    names = [target.id for target in node.targets if isinstance(target, ast.Name)]
    return names == ["__all__"] or (names != [] and names[0].istitle() and isinstance(node.value, ast.Subscript))


def _variants(node: ast.AST) -> Iterator[tuple[str, tuple[str, ast.AST]]]:
    """Yield the kinds of change of one node, each with its text and the new node."""
    for kind, new in _new(node):
        ast.copy_location(new, node)
        text = f"if {ast.unparse(new.test)}" if isinstance(new, ast.If) else ast.unparse(ast.fix_missing_locations(new))
        yield kind, (text, new)


def _new(node: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    match node:
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            for other in COMPARE[type(op)]:
                yield "comparison", ast.Compare(left, [other()], [right])
        case ast.Compare(left=left, ops=[first, second], comparators=[middle, right]):
            yield "comparison", ast.Compare(left, [first], [middle])
            yield "comparison", ast.Compare(middle, [second], [right])
        case ast.BinOp(left=left, op=op, right=right) if type(op) in ARITHMETIC and not _is_text(node):
            yield "arithmetic", ast.BinOp(left, ARITHMETIC[type(op)](), right)
        case ast.UnaryOp(op=ast.USub() | ast.Not() | ast.Invert(), operand=operand):
            yield "sign or not", operand
        case ast.Constant(value=bool(value)):
            yield "constant", ast.Constant(not value)
        case ast.Constant(value=int(value) | float(value)):
            yield "constant", ast.Constant(type(value)(0) if value else type(value)(1))
            if value:
                yield "constant", ast.Constant(value * 2)
        case ast.BoolOp(op=op, values=values):
            yield "and, or", ast.BoolOp(ast.Or() if isinstance(op, ast.And) else ast.And(), values)
            for k in range(len(values)):
                rest = values[:k] + values[k + 1 :]
                yield "and, or", rest[0] if len(rest) == 1 else ast.BoolOp(op, rest)
        case ast.If(test=test, body=body, orelse=orelse):
            yield "condition", ast.If(ast.Constant(False), body, orelse)
            yield "condition", ast.If(ast.Constant(True), body, orelse)
            del test
        case ast.IfExp(body=body, orelse=orelse):
            yield "condition", body
            yield "condition", orelse
        case ast.Call(func=func, args=args, keywords=keywords):
            yield from _calls(func, args, keywords)
        case ast.Return(value=ast.Compare() | ast.BoolOp() as value):
            yield "return", ast.Return(ast.UnaryOp(ast.Not(), value))
        case ast.Return(value=ast.List() | ast.Tuple() | ast.Dict() | ast.Constant(value=None) | None):
            return
        case ast.AugAssign(op=ast.Add() | ast.BitAnd() | ast.BitOr()):
            yield "statement left out", ast.Pass()
        case ast.Expr(value=ast.Call()):
            yield "statement left out", ast.Pass()
        case ast.Continue() | ast.Break():
            yield "statement left out", ast.Pass()
        case ast.ListComp(elt=elt, generators=[ast.comprehension(ifs=[_, *_]) as only]):
            yield "condition", ast.ListComp(elt, [ast.comprehension(only.target, only.iter, [], 0)])
        case ast.GeneratorExp(elt=elt, generators=[ast.comprehension(ifs=[_, *_]) as only]):
            yield "condition", ast.GeneratorExp(elt, [ast.comprehension(only.target, only.iter, [], 0)])
        case _:
            return


def _calls(func: ast.expr, args: list[ast.expr], keywords: list[ast.keyword]) -> Iterator[tuple[str, ast.AST]]:
    name = func.id if isinstance(func, ast.Name) else func.attr if isinstance(func, ast.Attribute) else ""
    if name in SWAPPED:
        yield "opposite call", ast.Call(_renamed(func, SWAPPED[name]), args, keywords)
    elif name in {"sorted", "abs"}:
        yield "call left out", ast.Call(ast.Name("list", ast.Load()), args[:1], []) if name == "sorted" else args[0]
    elif len(args) >= 2 and not any(isinstance(a, ast.Starred) for a in args[:2]) and name not in {"cast", "partial"}:
        yield "arguments swapped", ast.Call(func, [args[1], args[0], *args[2:]], keywords)


def _renamed(func: ast.expr, name: str) -> ast.expr:
    load = ast.Load()
    return ast.Attribute(func.value, name, load) if isinstance(func, ast.Attribute) else ast.Name(name, load)


def _is_text(node: ast.BinOp) -> bool:
    return any(
        isinstance(side, ast.JoinedStr) or (isinstance(side, ast.Constant) and isinstance(side.value, str))
        for side in (node.left, node.right)
    )
