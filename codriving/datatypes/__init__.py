"""The data types of all rooms: frozen dataclasses, and the base classes of what a config can name."""

from codriving.datatypes.cooperation import (
    EACH,
    NEAREST,
    UNITS,
    Coordination,
    OrderAgreement,
    OrderMessage,
    Party,
    Proposal,
    Response,
)
from codriving.datatypes.experience import Description, Effect, Experience, Interaction, Memory, Verdict
from codriving.datatypes.flow import Flow
from codriving.datatypes.judgement import GOES, UNCLEAR, YIELDS, Judgement, Judgements, MetDriver
from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.order import (
    Approach,
    ApproachingVehicle,
    Conflict,
    Instance,
    Pair,
    PassingOrder,
    Precedence,
    Relation,
    Severity,
)
from codriving.datatypes.outlook import ActionOutlook, ExpectedPassage, HumanOutlook, Outlook, PastDecision
from codriving.datatypes.parts import (
    Account,
    ActionFilter,
    CaseMemory,
    Chat,
    Communication,
    Cooperation,
    Drivers,
    EpisodeLauncher,
    HumanJudge,
    Method,
    Metric,
    Model,
    OrderExecutor,
    OrderOfCavs,
    RuleModel,
    Scenario,
    Shares,
    Simulator,
    ThinkingTime,
    Wrapped,
)
from codriving.datatypes.record import (
    BLOCKER,
    Collision,
    Ending,
    EpisodeRecord,
    FlowArrival,
    FlowLog,
    NamedNumber,
    Outcome,
    Participant,
    Pet,
    Score,
    Track,
    Trajectory,
    TravelScore,
)
from codriving.datatypes.road import (
    Arc,
    Block,
    Lane,
    LaneId,
    LaneShape,
    Line,
    Point,
    Road,
    Route,
    Sine,
    Straight,
    Turn,
    beside,
)
from codriving.datatypes.situation import (
    ActionAssessment,
    Decision,
    Deliberation,
    LaneChange,
    LaneNeighbour,
    ReasonedDeliberation,
    Role,
    SceneDescription,
    Situation,
    TrackedVehicle,
)
from codriving.datatypes.stress import StressAxis, StressLevel
from codriving.datatypes.world import (
    Action,
    ControlInput,
    DrivingModel,
    Intent,
    Kind,
    Manner,
    Scene,
    Start,
    Told,
    VehicleState,
    WorldState,
)

__all__ = [
    "BLOCKER", "EACH", "GOES", "NEAREST", "UNCLEAR", "UNITS", "YIELDS", "Account", "Action", "ActionAssessment",
    "ActionFilter", "ActionOutlook", "Approach", "ApproachingVehicle", "Arc", "Block", "CaseMemory", "Chat",
    "Collision", "Communication", "Conflict", "ControlInput", "Cooperation", "Coordination", "Decision", "Deliberation",
    "Description", "Drivers", "DrivingModel", "Effect", "Ending", "EpisodeLauncher", "EpisodeRecord", "ExpectedPassage",
    "Experience", "Flow", "FlowArrival", "FlowLog", "HumanJudge", "HumanOutlook", "Instance", "Intent", "Interaction",
    "Judgement", "Judgements", "Kind", "Lane", "LaneChange", "LaneId", "LaneNeighbour", "LaneShape", "Line", "Manner",
    "Memory", "MetDriver", "Method", "Metric", "Model", "NamedNumber", "OrderAgreement", "OrderExecutor",
    "OrderMessage", "OrderOfCavs", "Outcome", "Outlook", "Pair", "Participant", "Party", "PassingOrder", "PastDecision",
    "Pet", "Point", "Precedence", "Proposal", "ReasonedDeliberation", "Relation", "Response", "Road", "Role", "Route",
    "RuleModel", "Scenario", "Scene", "SceneDescription", "Score", "Severity", "Shares", "Simulator", "Sine",
    "Situation", "Start", "Straight", "StressAxis", "StressLevel", "ThinkingTime", "Told", "Track", "TrackedVehicle",
    "Trajectory", "TravelScore", "Turn", "VehicleLimits", "VehicleState", "Verdict", "WorldState", "Wrapped", "beside",
]  # fmt: skip
