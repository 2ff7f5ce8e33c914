"""Where faults are put, and which tests have to find them: a binary of the build with a filter."""


def place(file, target, suites, seconds=60, others=()):
    return {"file": file, "target": target, "seconds": seconds, "suites": suites, "others": others}


def engine(file, suites, seconds=60):
    return place(f"engine/{file}", "engine_tests", suites, seconds)


def gcode(file, suites, seconds=60):
    return place(f"client/gcode/{file}", "gcode_tests", suites, seconds)


def verify(file):
    return place(f"client/gcode/verify/{file}", "gcode_verify_tests", "Verify*:SamePrint*:PermissionsInHead*")


# What ShuffledFile and Golden write is held against the verifier and against files looked at by eye.
WRITTEN = "LayerWriter*:LinkComposer*:*ShortPath*:RewriteGcode*:Dialects/Golden*:Kept/ShuffledFile*"

PLACES = [
    place("server/access/auth.cc", "server_jobs_tests", "ParseTokens*:Authenticator*"),
    place("server/jobs/admission.cc", "server_jobs_tests", "Admission*"),
    place("server/jobs/retry_delay.cc", "server_jobs_tests", "WithRetryDelay*"),
    place("server/jobs/job_run.cc", "server_jobs_tests", "JobRun*"),
    place("server/jobs/return_margin.h", "server_jobs_tests", "MarginOfReturn*"),
    place("server/jobs/worker_pool.cc", "server_jobs_tests", "WorkerPool*"),
    place("server/jobs/worker_threads.cc", "server_jobs_tests", "WorkerPool*"),
    place("server/server.cc", "server_tests", "Drain*:Service*:Overload*", others=("server_binary_tests",)),
    place("server/jobs/fair_order.h", "server_jobs_tests", "FairOrder*:WorkerPool*"),
    place("client/api/optimizer_client.cc", "client_tests", "Resume*:OptimizerClient*"),
    place("client/api/resume.cc", "client_tests", "Resume*:ShiftPlace*:FirstMissing*:CleaningDueAfter*"),
    gcode("choose/rows/choice_row.cc", "BestRow*"),
    gcode("choose/layer_choice.cc", f"BestRow*:LayerChooser*:{WRITTEN}"),
    gcode("choose/merged_orders.cc", f"OrderMerger*:{WRITTEN}"),
    gcode("choose/orders/order_merge.cc", "OrderMerger*"),
    gcode("machine/machine_limits.cc", "MachineLimits*"),
    gcode("machine/motion_planner.cc", "MotionPlanner*:StopToStop*:Measure*"),
    gcode("plan/layer_plan.cc", "Policy*:Precedence*"),
    gcode("plan/policy.cc", "Policy*:Precedence*"),
    gcode("plan/travel_rules.cc", "TravelRules*"),
    gcode("text/decimal.cc", "Decimal*:NumberStyle*"),
    verify("machine/command_words.cc"),
    verify("machine/print_settings.cc"),
    verify("machine/verify_machine.cc"),
    verify("match/visits.cc"),
    verify("rules/travel/lifts.cc"),
    verify("rules/travel/open_travel.cc"),
    verify("rules/order.cc"),
    verify("rules/retractions.cc"),
    verify("sections.cc"),
    gcode("write/gcode_out.cc", WRITTEN),
    gcode("link/boundary_composer.cc", WRITTEN),
    gcode("link/composer.cc", WRITTEN),
    gcode("write/path_writer.cc", WRITTEN),
    gcode("model/placed_path.cc", f"PlacedPath*:{WRITTEN}"),
    place("client/loadgen/latency_histogram.cc", "loadgen_tests", "LatencyHistogram*"),
    place("client/loadgen/load_report.cc", "loadgen_tests", "LoadReport*"),
    place("client/files/write_file.cc", "client_tests", "WriteFile*"),
    place("client/damat/reader.cc", "client_tests", "Damat*:*Reader*"),
    engine("schedule/route_history.cc", "RouteHistory*:LayerChain*"),
    engine("schedule/layer_fingerprint.cc", "EndHistory*:FingerprintOf*:ProblemKey*"),
    engine("schedule/budget_split.h", "BudgetSplit*"),
    engine("cost/entry_choice.cc", "EntryChoice*"),
    engine("cost/entry_table.cc", "EntryTable*"),
    engine("cost/neighbor_lists.cc", "NeighborLists*"),
    engine("geometry/convex_hull.cc", "ConvexHull*:OuterTangents*"),
    engine("geometry/nearest_point_index.cc", "NearestPointIndex*"),
    engine("geometry/visibility_polygon.cc", "VisibilityPolygon*:VisiblePoints*"),
    engine("search/greedy/frontier.cc", "Greedy*"),
    engine("search/move_evaluator.cc", "MoveEvaluator*"),
    engine("search/search_state.cc", "SearchState*:MoveEvaluator*"),
    engine("search/turn_run.cc", "TurnRun*"),
    engine("souza/block_line.cc", "BlockLine*"),
    engine("souza/point_release.cc", "PointRelease*"),
    engine("souza/nearest_insertion.cc", "NearestInsertion*"),
    engine("proof/small_parts/small_parts.cc", "SmallParts*:IsSmall*"),
    engine("proof/walks/walk_dp.cc", "WalkDp*"),
    engine("weller/tabu/swap_sequence.cc", "SwapSequence*"),
    engine("weller/tabu/tabu_list.h", "TabuList*"),
    engine("weller/steps/point_reduction.cc", "PointReduction*:AnalyzeIslands*:SpacedPoints*:NearRasterPoints*:BoxCenterPoint*"),
    engine("weller/steps/neighborhood.cc", "Neighborhood*:GrowCircles*:LinkClusters*:IslandNeighborhood*"),
    engine("validator.cc", "ValidateRoute*:MeasureTravel*"),
]

# Faults that make no difference, as their lines say then, and why.
COUNTS_FOR_AN_ASSERTION = "what it counts is looked at in an assertion"
ORDER_ON_THE_CURVE = "which points share a leaf changes how long a search takes, and not what it finds"
PRUNES_LESS = "a bound that rules out less: the cost itself is looked at behind it"
NOTHING_TO_LET_IN = "tasks are held back only while all permits are in use"
POINT_INDEX = "engine/geometry/nearest_point_index.cc"
EQUIVALENT = {
    (POINT_INDEX, "without x &= 0xffff;"): ORDER_ON_THE_CURVE,
    (POINT_INDEX, "without x = (x | (x << 8)) & 0x00ff00ff;"): ORDER_ON_THE_CURVE,
    (POINT_INDEX, "without x = (x | (x << 4)) & 0x0f0f0f0f;"): ORDER_ON_THE_CURVE,
    (POINT_INDEX, "without x = (x | (x << 2)) & 0x33333333;"): ORDER_ON_THE_CURVE,
    (POINT_INDEX, "without x = (x | (x << 1)) & 0x55555555;"): ORDER_ON_THE_CURVE,
    (POINT_INDEX, "without std::swap(keys, sorted);"): ORDER_ON_THE_CURVE,
    (POINT_INDEX, "if (!(keys.size() < kMinSize)) return std::sort(keys.begin(), keys.end());"):
        ORDER_ON_THE_CURVE,
    ("engine/search/turn_run.cc",
     "return state.position(begin) == first && state.position(end) + tree.size(end) - 1 != last;"):
        COUNTS_FOR_AN_ASSERTION,
    ("engine/souza/block_line.cc", "const double limit = gone + move_[j + 1] - detour_[j] - best.delta;"): PRUNES_LESS,
    ("server/jobs/worker_pool.cc", "if (memory_short_ || !is_short) {"): NOTHING_TO_LET_IN,
    ("engine/cost/neighbor_lists.cc", "if (far_squared >= near_squared ||"): PRUNES_LESS,
}
