"""`codriving memory`: build, show, search and merge what CAVs remember."""

from pathlib import Path
from typing import Annotated

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig

memory = typer.Typer(
    help="What CAVs remember: build a memory, look into it, search it, merge two.",
    no_args_is_help=True,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

File = Annotated[
    Path | None, typer.Option("--file", metavar="FILE", help="The memory; the newest below outputs/ if left out.")
]
Most = Annotated[int, typer.Option("--most", min=1, max=1000, help="How many experiences to show.")]


@memory.command(epilog="Example: codriving memory build scenario=intersection interactions=20 run=learnt")
def build(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Drive interactions=N episodes to learn from, on seeds from 20000 on, and keep what was learnt in a file.

    The same command with the same run=NAME goes on where it was interrupted, or grows it by more interactions.
    """
    from codriving.commands import BUILD, run_command

    raise typer.Exit(run_command(BUILD, overrides or [], config_dir, cfg))


@memory.command(epilog="Example: codriving memory show outputs/memory/learnt/memory/intersection-codriving-full.sqlite")
def show(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="The memory; the newest below outputs/ if left out.")
    ] = None,
    most: Most = 5,
) -> None:
    """Show what a memory is of, and what was experienced most often."""
    from codriving.commands import show_page

    print(show_page(file, most))


@memory.command(epilog='Example: codriving memory search "crossing with a human, dTTCP 0.5 s" --most 3')
def search(
    text: Annotated[str, typer.Argument(metavar="TEXT", help="Words to look for; near numbers count, too.")],
    file: File = None,
    most: Most = 5,
) -> None:
    """Search a memory for words."""
    from codriving.commands import search_page

    print(search_page(text, file, most))


@memory.command(epilog="Example: codriving memory merge a.sqlite b.sqlite --out both.sqlite")
def merge(
    first: Annotated[Path, typer.Argument(metavar="A", help="A memory; its interactions come first.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another one, of the same embedder.")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="The file to make; A+B.sqlite beside A.")
    ] = None,
    duplicates: Annotated[
        float, typer.Option(min=0.5, max=1.0, help="Similarity from which on two experiences are one.")
    ] = 0.98,
) -> None:
    """Merge two memories into a new file; neither of them is changed."""
    from codriving.commands import merge_page

    print(merge_page(first, second, out, duplicates))
