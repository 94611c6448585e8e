"""All commands, and the one place where a user's mistake becomes a line on the screen."""

import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from codriving import __version__
from codriving.cli.commands import ablate, check, compare, learn, list_choices, replay, run, train
from codriving.cli.memory import memory
from codriving.errors import UserError

USER_ERROR, INTERRUPTED = 2, 130


class _Commands(TyperGroup):
    """The commands, with errors shown as the user needs them: mistakes in one line, bugs with their traceback."""

    def parse_args(self, ctx: typer.Context, args: list[str]) -> list[str]:  # type: ignore[override]
        # For a flag without default, as Typer's own are, Typer imports a validator on every start (0.1 s).
        for param in self.get_params(ctx):
            if param.name in ("help", "install_completion", "show_completion"):
                param.default = False
        return super().parse_args(ctx, args)

    def invoke(self, ctx: typer.Context) -> Any:  # type: ignore[override]  # noqa: ANN401
        try:
            return super().invoke(ctx)
        except UserError as err:
            print(f"error: {' '.join(str(err).split())}", file=sys.stderr)
            raise typer.Exit(USER_ERROR) from err
        except KeyboardInterrupt as err:
            print("interrupted", file=sys.stderr)
            raise typer.Exit(INTERRUPTED) from err


app = typer.Typer(
    cls=_Commands,
    help="Cooperative driving with rules or language models, on highway-env.",
    epilog="Example: codriving run scenario=intersection episodes=20",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"codriving {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """Cooperative driving with rules or language models, on highway-env."""


app.command(epilog="Example: codriving run scenario=intersection episodes=50 seed=0 workers=2 run=first")(run)
app.command(epilog="Example: codriving ablate scenario=intersection episodes=20")(ablate)
app.command(epilog="Example: codriving compare baselines scenario=intersection episodes=20")(compare)
app.command(epilog="Example: codriving learn scenario=intersection interactions=0,5,20 episodes=50 run=curve")(learn)
app.command(epilog="Example: codriving check llm=openai llm.model=openai/gpt-4o-mini")(check)
app.command(epilog="Example: codriving replay outputs/run/first --episode 3 --format gif")(replay)
app.add_typer(memory, name="memory")
app.command(epilog="Example: codriving train madqn --family junction seed=1")(train)
app.command("list", epilog="Example: codriving list scenarios")(list_choices)


def main() -> None:
    """Run the command line."""
    app()
