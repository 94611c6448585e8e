"""`codriving replay`: a film of a stored episode, or a picture of one moment."""

from pathlib import Path
from typing import Annotated

import typer

from codriving.cli.arguments import ConfigDir
from codriving.cli.completion import complete_format


def replay(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="A run folder, or the name of one under outputs/.")],
    episode: Annotated[int | None, typer.Option(metavar="N", help="Its seed; the first one if not given.")] = None,
    cell: Annotated[
        str | None, typer.Option(metavar="NAME", help="Which row of the table, or a part of its name; for a sweep.")
    ] = None,
    format: Annotated[
        str | None, typer.Option(metavar="mp4|gif", help="mp4 if not given.", autocompletion=complete_format)
    ] = None,
    out: Annotated[Path | None, typer.Option(metavar="FILE", help="Beside the episode's record if not given.")] = None,
    speed: Annotated[float | None, typer.Option(metavar="X", help="Seconds of driving a second of film: 1.")] = None,
    fps: Annotated[float | None, typer.Option(metavar="X", help="Frames a second: 25, and 10 for a gif.")] = None,
    scale: Annotated[float, typer.Option(metavar="X", help="0.5 to 4; at 1 a frame has 1280 x 720 pixels.")] = 1.0,
    frame: Annotated[
        float | None, typer.Option(metavar="T", help="A PNG of one moment [s] in place of a film.")
    ] = None,
    config_dir: ConfigDir = None,
) -> None:
    """Show a stored episode: road, vehicles, conflicts, what every CAV decides and why."""
    from codriving.experiment.replay import ReplayOptions
    from codriving.experiment.replay import replay as show

    print(show(run, ReplayOptions(cell, episode, format, out, speed, fps, scale, frame, config_dir)))
