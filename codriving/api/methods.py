"""Methods that are given to a call, by name, as objects or as classes."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from codriving.config import Given, Point, parse, written
from codriving.errors import ConfigError, require
from codriving.reports import REFERENCE

BESIDE = ("baselines", "single-vehicle", "all", "load")  # The tables of ``compare`` that take objects


@dataclass(frozen=True)
class ChosenMethods:
    """The methods of one call."""

    items: tuple[str | Given, ...]

    @classmethod
    def of(cls, method: object) -> "ChosenMethods":
        """Take one, several in a list or a tuple, or None."""
        several = method if isinstance(method, list | tuple) else () if method is None else (method,)
        require(method is None or bool(several), "method is an empty list; name a method, or leave it out")
        return cls(tuple(one if isinstance(one, str) else Given.of(one) for one in several))

    @property
    def given(self) -> tuple[Given, ...]:
        """The objects and classes among them."""
        return tuple(one for one in self.items if isinstance(one, Given))

    def refuse_in(self, table: str) -> None:
        """Refuse objects in a table that varies something else than methods."""
        if self.given and table not in BESIDE:
            raise ConfigError(
                f"compare {table} takes methods by their names alone, and objects stand in {', '.join(BESIDE)}; put "
                "the class into a module with a YAML and give its name"
            )

    @property
    def named(self) -> list[str]:
        """The names among them, as ``key=value`` tokens."""
        return [f"method={one}" for one in self.items if isinstance(one, str)]

    def tokens(self, overrides: Iterable[object]) -> list[str]:
        """Check what is asked for besides; what cannot go to worker processes is driven in this one."""
        tokens = written(overrides)
        keys = {token: parse(token).key_or_group for token in tokens}
        if self.items and "method" in keys.values():
            raise ConfigError(
                "method is given as a text and as an argument; give all of them in one list, method=[...]"
            )
        if not self.given:
            return tokens
        for token, key in keys.items():
            if key.startswith("method."):
                raise ConfigError(f"{token} does not reach an object; give it the value where it is made")
        if why := next(filter(None, (one.stays for one in self.given)), ""):
            for token, key in keys.items():
                value = token.partition("=")[2]
                if (key == "workers" and value not in ("1", "auto")) or (key == "launcher" and value != "serial"):
                    raise ConfigError(
                        f"{why}, so no worker process can make it; leave {token} out, or put the class into a module"
                    )
            tokens.append("launcher=serial")
        return tokens

    def each(self, points: Sequence[Point]) -> Sequence[Point]:
        """Drive every config with each of them."""
        return [self._put(point, one) for point in points for one in self.items] if self.items else points

    def beside(self, points: Sequence[Point]) -> Sequence[Point]:
        """Set the objects beside the methods of a comparison, in each of its settings."""
        places = [point for point in points if point.swept.get("method") == REFERENCE]
        found = list[Point]()
        for point in points:
            found += [point, *(self._put(point, one) for one in self.given if point in places)]
        return found

    def _put(self, point: Point, one: str | Given) -> Point:
        name, base = (one, one) if isinstance(one, str) else (one.name, one.base)
        swept = {**point.swept, "method": name} if len(self.items) > 1 or "method" in point.swept else point.swept
        given = one if isinstance(one, Given) else None
        return replace(point, overrides=(*point.overrides, f"method={base}"), swept=swept, given=given)


NONE = ChosenMethods(())
