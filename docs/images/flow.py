"""Draws docs/images/flow.svg: the data that flow through the program, and the room that makes each."""

from pathlib import Path

BOX_WIDTH, BOX_HEIGHT, GAP, LEFT = 118, 44, 22, 112
ROWS = [
    ("world", "#e3ecf7", "#33597f", 30, [("seed", ""), ("scene", "environment"), ("world state", "environment")]),
    (
        "mind",
        "#e4f2e4",
        "#2f6b3c",
        140,
        [
            ("shared states", "reasoning"),
            ("shared intents", "reasoning"),
            ("conflicts", "reasoning"),
            ("passing order", "reasoning, llm"),
            ("safe actions", "reasoning"),
            ("memories", "memory"),
            ("decisions", "methods, llm"),
        ],
    ),
    (
        "evidence",
        "#f7efdd",
        "#7a5a18",
        250,
        [("trajectory", "runs"), ("score", "metrics"), ("tables", "reports")],
    ),
]
WIDTH, HEIGHT = LEFT + 7 * (BOX_WIDTH + GAP) + 10, 330


def text(x: float, y: float, words: str, size: int = 13, colour: str = "#222222", more: str = "") -> str:
    """Return a line of text, centred at x unless ``more`` says otherwise."""
    style = f'font-size="{size}" fill="{colour}" text-anchor="middle"'
    return f'<text x="{x:g}" y="{y:g}" {style} {more}>{words}</text>'


def arrow(*points: tuple[float, float]) -> str:
    """Return an arrow along points."""
    way = " ".join(f"{x:g},{y:g}" for x, y in points)
    return f'<polyline points="{way}" fill="none" stroke="#555555" stroke-width="1.4" marker-end="url(#tip)"/>'


def place(row: int, column: int) -> tuple[float, float]:
    """Return the left upper corner of a box."""
    return LEFT + column * (BOX_WIDTH + GAP), ROWS[row][3]


def draw() -> str:
    """Return the picture."""
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" role="img">',
        "<title>The flow of data, from a seed to tables</title>",
        '<defs><marker id="tip" markerWidth="8" markerHeight="8" refX="7" refY="3.5" orient="auto">'
        '<path d="M0,0 L7,3.5 L0,7 z" fill="#555555"/></marker></defs>',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
    ]
    middle = BOX_HEIGHT / 2
    for row, (group, fill, colour, top, boxes) in enumerate(ROWS):
        parts.append(text(12, top + middle + 5, group, 15, colour, 'font-weight="bold" style="text-anchor:start"'))
        for column, (name, room) in enumerate(boxes):
            x, y = place(row, column)
            style = f'rx="6" fill="{fill}" stroke="{colour}"'
            parts.append(f'<rect x="{x:g}" y="{y:g}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" {style}/>')
            parts.append(text(x + BOX_WIDTH / 2, y + (18 if room else 27), name))
            if room:
                parts.append(text(x + BOX_WIDTH / 2, y + 35, room, 11, colour, 'font-family="monospace"'))
            if column:
                parts.append(arrow((x - GAP + 2, y + middle), (x - 2, y + middle)))
    state, shared, decided = place(0, 2), place(1, 0), place(1, 6)
    half = BOX_WIDTH / 2
    turn = (state[1] + BOX_HEIGHT + shared[1]) / 2
    parts.append(
        arrow(
            (state[0] + half, state[1] + BOX_HEIGHT),
            (state[0] + half, turn),
            (shared[0] + half, turn),
            (shared[0] + half, shared[1] - 3),
        )
    )
    parts.append(
        arrow(
            (decided[0] + half, decided[1]),
            (decided[0] + half, state[1] + middle),
            (state[0] + BOX_WIDTH + 3, state[1] + middle),
        )
    )
    parts.append(text(decided[0] - 150, state[1] + middle - 8, "step: actions move the vehicles", 12, "#555555"))
    driven = place(2, 0)
    side = LEFT - 14
    parts.append(
        arrow(
            (state[0] + half + 20, state[1] + BOX_HEIGHT),
            (state[0] + half + 20, turn + 12),
            (side, turn + 12),
            (side, driven[1] + middle),
            (driven[0] - 3, driven[1] + middle),
        )
    )
    parts.append("</svg>")
    return "\n".join(parts) + "\n"


if __name__ == "__main__":
    Path(__file__).with_suffix(".svg").write_text(draw(), encoding="utf-8")
