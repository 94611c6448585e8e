"""`codriving ablate`: the reasoning module with each sub-module removed in turn."""

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig


def ablate(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Run the full method and each reasoning sub-module removed, on the same seeds, into one table."""
    if cfg:
        from codriving.cli.config_page import print_configs
        from codriving.config.sweep import expand
        from codriving.experiment.ablation import ablation_points

        print_configs(ablation_points(expand(overrides or [], config_dir)), config_dir)
        return
    from codriving.experiment import run_ablation

    raise typer.Exit(run_ablation(overrides or [], config_dir))
