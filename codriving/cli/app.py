"""All commands, and the one place where a user's mistake becomes a line on the screen."""

import os
import re
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from codriving.cli.commands import (
    ablate,
    bound,
    check,
    compare,
    exam,
    experiment,
    export,
    figures,
    join,
    learn,
    list_choices,
    replay,
    report,
    run,
    score,
    stress,
    train,
)
from codriving.cli.memory import memory
from codriving.cli.streams import OutputError, give_up_output, mend_streams
from codriving.errors import UserError
from codriving.version import __version__

_HOME = re.compile(r"\A(|--?[a-z-]+=)~(?=/|\Z)")

USER_ERROR, INTERRUPTED, PIPE_CLOSED = 2, 130, 141


class _Commands(TyperGroup):
    """The commands, with whatever goes wrong in one line."""

    def main(self, args: Sequence[str] | None = None, prog_name: str | None = None, **options: Any) -> Any:  # type: ignore[override]  # noqa: ANN401
        given = list(sys.argv[1:] if args is None else args)
        mend_streams()
        _ignore_variables()
        with _ending(given) as ending:
            _refuse_unreadable(given)
            # In options the shell leaves ~ as it is.
            given = [_HOME.sub(lambda match: match[1] + str(Path.home()), arg) for arg in given]
            ending.code = super().main(given, "codriving", **{**options, "standalone_mode": False})
        sys.exit(ending.code if isinstance(ending.code, int) else 0)

    def parse_args(self, ctx: typer.Context, args: list[str]) -> list[str]:  # type: ignore[override]
        # For a flag without default, as Typer's own are, Typer imports a validator on every start (0.1 s).
        for param in self.get_params(ctx):
            if param.name in ("help", "install_completion", "show_completion"):
                param.default = False
        rest = super().parse_args(ctx, args)
        if not ctx.resilient_parsing:
            _refuse_folder_that_is_gone()
        return rest


@dataclass
class _Ending:
    """How the program ends: what a command has returned, or the exit code of what went wrong."""

    code: object = 0


@contextmanager
def _ending(args: list[str]) -> Iterator[_Ending]:
    """Make one line of whatever goes wrong."""
    ending = _Ending()
    try:
        try:
            yield ending
        except UserError as error:
            ending.code = _refused(error)
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            ending.code = INTERRUPTED
        except Exception as error:
            ending.code = _code_of(error, args)
        sys.stdout.flush()
    except OutputError as error:
        give_up_output()
        ending.code = PIPE_CLOSED if error.reader_is_gone else _refused(error)


def _code_of(error: Exception, args: list[str]) -> int:
    if "_CODRIVING_COMPLETE" in os.environ:
        return 1  # Whatever a shell asks after TAB, words on the screen would stand in the line being typed
    from codriving.cli.faults import one_line

    if type(error).__name__ == "NoArgsIsHelpError":
        print(error, file=sys.stderr)
        return USER_ERROR
    return _refused(one_line(error, args))


def _refuse_folder_that_is_gone() -> None:
    try:
        Path.cwd()
    except OSError as error:
        raise UserError(f"the current folder cannot be used ({error.strerror}); change to one that exists") from error


def _refused(said: object) -> int:
    if isinstance(said, OutputError) and said.reader_is_gone:
        raise said
    print(f"error: {' '.join(str(said).split())}", file=sys.stderr)
    return USER_ERROR


def _refuse_unreadable(args: Sequence[str]) -> None:
    """Names that no file of the run could hold are refused before they get anywhere."""
    for arg in args:
        if "\0" in arg or any("\ud800" <= character <= "\udfff" for character in arg):
            raise UserError(
                f"{arg!a} holds bytes that are no text in {sys.getfilesystemencoding()}; write it in that encoding, "
                "or choose another with LC_ALL=C.UTF-8"
            )


def _ignore_variables() -> None:
    """Keep out what environment variables would do to libraries that this program uses in its own way."""
    # Drawing needs no window, and a notebook's value names a module that only the notebook has.
    os.environ["MPLBACKEND"] = "agg"
    if any(option.startswith("error") for option in sys.warnoptions):
        # A warning of a library's is not the user's to mend; workers inherit these.
        os.environ.pop("PYTHONWARNINGS", None)
        sys.warnoptions.clear()
        warnings.resetwarnings()
        warnings.simplefilter("ignore")


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
app.command(epilog="Example: codriving stress humans scenario=intersection episodes=60")(stress)
app.command(epilog="Example: codriving bound scenario=intersection scenario.cavs=12 episodes=40")(bound)
app.command(epilog="Example: codriving learn scenario=intersection interactions=0,5,20 episodes=50 run=curve")(learn)
app.command(epilog="Example: codriving experiment ablation episodes=20 run=first")(experiment)
app.command(epilog="Example: codriving join outputs/run/big")(join)
app.command(epilog="Example: codriving check llm=openai llm.model=openai/gpt-4o-mini")(check)
app.command(epilog="Example: codriving exam llm=local --most 40")(exam)
app.command(epilog="Example: codriving replay outputs/run/first --episode 3 --format gif")(replay)
app.command(epilog="Example: codriving report outputs/run/first outputs/run/second --out page.html")(report)
app.command(epilog="Example: codriving figures outputs/run/first")(figures)
app.command(epilog="Example: codriving score recording.csv outputs/run/first metrics=authors --csv scores.csv")(score)
app.command(epilog="Example: codriving export outputs/run/first --to fcd --episode 3")(export)
app.add_typer(memory, name="memory")
app.command(epilog="Example: codriving train madqn --family junction seed=1")(train)
app.command("list", epilog="Example: codriving list scenarios")(list_choices)


def main(args: Sequence[str] | None = None) -> None:
    """Run the command line, and end with its exit code.

    Args:
        args: What is typed after ``codriving``; None for what the process was given.

    Raises:
        SystemExit: Always.
    """
    app(args)
