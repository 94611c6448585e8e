"""Who passes first: orders, the schedules that follow from them, and the rules that choose one.

What a rule of one's own needs is here by name; see docs/methods/README.md.
"""

from codriving.datatypes import ApproachingVehicle, Instance
from codriving.reasoning import (
    JointPlan,
    JointPlanner,
    Ordering,
    OrderRule,
    Request,
    best_subset,
    evacuation_time,
    in_order,
    repaired,
    schedule,
    total_delay,
)

__all__ = [
    "ApproachingVehicle",
    "Instance",
    "JointPlan",
    "JointPlanner",
    "OrderRule",
    "Ordering",
    "Request",
    "best_subset",
    "evacuation_time",
    "in_order",
    "repaired",
    "schedule",
    "total_delay",
]
