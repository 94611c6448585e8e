"""``thinking``: how long a method takes to think, in the time of the world that it drives in."""

from codriving.datatypes import Method, Model, ThinkingTime, Wrapped
from codriving.errors import require_range
from codriving.methods import CoDriving, Ordered
from codriving.reasoning import CdaLevel
from codriving.wrappers.delays import NONE, Delays
from codriving.wrappers.filtered import Filtered
from codriving.wrappers.slow import Slow, SlowCoDriving

MARGIN = 1.5  # That of the safety check behind a method that has none [s], as ``filter=true`` has it

NO_MIND = "it has no mind, its CAVs drive as human drivers do"
NO_ORDER = "there is no common order in it, so that thinking.order alone takes no time"

LONGEST = 30.0  # Beyond this an episode is over before it has begun [s]


class Thinking(ThinkingTime):
    """Times for decisions and orders; with a language model ``llm.latency`` takes their place, if it is set.

    What has no mind of its own, and what orders nothing, takes no time.
    """

    def __init__(self, mind: float, order: float, cda: CdaLevel) -> None:
        require_range("mind", mind, 0, LONGEST, " s")
        require_range("order", order, 0, LONGEST, " s")
        self.mind, self.order, self.cda = mind, order, cda

    def around(self, method: Method, llm: Model | None) -> Method:
        delays = Delays(self.mind, self.order, NONE if llm is None else llm.latency)
        inner = method.method if isinstance(method, Filtered) else method
        if inner.hands_over or not self._takes(inner, delays):
            return method
        if isinstance(inner, CoDriving):
            slow = SlowCoDriving(inner, delays)
            if not isinstance(method, Filtered):
                return slow
            method.method = slow
            return method
        if isinstance(method, Filtered):
            return Slow(inner, method.cda, method.margin, delays)
        return Slow(inner, self.cda, MARGIN, delays)

    def notes(self, method: Method) -> tuple[str, ...]:
        inner = method
        while isinstance(inner, Wrapped) and not isinstance(inner, Slow | SlowCoDriving):
            inner = inner.method
        if isinstance(inner, Slow | SlowCoDriving):
            meanwhile = "the safety check drives {} meanwhile, and checks late answers"
            return (f"Thinking takes time ({inner.delays}): {meanwhile}.",)
        if self.mind == self.order == 0:
            return ()
        return (f"thinking has no effect on {{}}: {NO_MIND if inner.hands_over else NO_ORDER}.",)

    def _takes(self, method: Method, delays: Delays) -> bool:
        """Whether it takes a method time to think."""
        orders = (
            method.cda.negotiation if isinstance(method, CoDriving) else isinstance(method, Ordered) and method.orders
        )
        return delays.mind > 0 or delays.by_model or (orders and delays.order > 0)
