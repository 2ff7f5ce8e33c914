// Writes traverse.json beside this file, or to the path given.
//
//   npm ci && node build.mjs
//
// Six rows: what the fleet is worth, traffic, latency, saturation, quality, files through gateways. Queries of the whole fleet
// use the recording rules of ../rules/recording.yml, those by server the metrics themselves.
import { writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import * as dashboard from "@grafana/grafana-foundation-sdk/dashboard";
import * as common from "@grafana/grafana-foundation-sdk/common";
import * as prometheus from "@grafana/grafana-foundation-sdk/prometheus";
import * as stat from "@grafana/grafana-foundation-sdk/stat";
import * as timeseries from "@grafana/grafana-foundation-sdk/timeseries";
import * as heatmap from "@grafana/grafana-foundation-sdk/heatmap";
import * as table from "@grafana/grafana-foundation-sdk/table";

const SOURCE = { type: "prometheus", uid: "${datasource}" };
const FLEET = 'job=~"$job"';
const SERVERS = `${FLEET}, instance=~"$instance"`;
const RATE = "$__rate_interval";

// A panel's queries: [[expression, legend], ...].
function withQueries(panel, queries, { instant = false, format } = {}) {
  for (const [index, [expression, legend]] of queries.entries()) {
    const query = new prometheus.DataqueryBuilder()
      .refId("ABCDEF"[index]).datasource(SOURCE).expr(expression).legendFormat(legend ?? "");
    if (instant) query.instant();
    if (format) query.format(format);
    panel.withTarget(query);
  }
  return panel.datasource(SOURCE);
}

function steps(...values) {
  return new dashboard.ThresholdsConfigBuilder()
    .mode(dashboard.ThresholdsMode.Absolute)
    .steps(values.map(([value, color]) => ({ value, color })));
}

const NEUTRAL = steps([null, "blue"]);

function tile(title, description, unit, expression, thresholds = NEUTRAL) {
  const panel = new stat.PanelBuilder()
    .title(title).description(description).unit(unit).height(4).span(4).noValue("none yet")
    .graphMode(common.BigValueGraphMode.Area).colorMode(common.BigValueColorMode.Value)
    .reduceOptions(new common.ReduceDataOptionsBuilder().calcs(["lastNotNull"]))
    .thresholds(thresholds);
  return withQueries(panel, [[expression, "{{job}}"]]);
}

function chart(title, description, unit, queries, { span = 8, stacked = false, max } = {}) {
  const panel = new timeseries.PanelBuilder()
    .title(title).description(description).unit(unit).min(0).height(8).span(span)
    .lineWidth(1).fillOpacity(stacked ? 40 : 8)
    .legend(new common.VizLegendOptionsBuilder()
      .displayMode(common.LegendDisplayMode.List).placement(common.LegendPlacement.Bottom).showLegend(true))
    .tooltip(new common.VizTooltipOptionsBuilder()
      .mode(common.TooltipDisplayMode.Multi).sort(common.SortOrder.Descending));
  if (stacked) panel.stacking(new common.StackingConfigBuilder().mode(common.StackingMode.Normal));
  if (max !== undefined) panel.max(max);
  return withQueries(panel, queries);
}

function heat(title, description, expression) {
  const panel = new heatmap.PanelBuilder()
    .title(title).description(description).height(8).span(12).calculate(false)
    .yAxis(new heatmap.YAxisConfigBuilder().unit("s"))
    .color(new heatmap.HeatmapColorOptionsBuilder()
      .mode(heatmap.HeatmapColorMode.Scheme).scheme("Blues").steps(64));
  return withQueries(panel, [[expression, "{{le}}"]], { format: prometheus.PromQueryFormat.Heatmap });
}

function quantiles(metric) {
  return [0.5, 0.9, 0.99].map((q) => [
    `histogram_quantile(${q}, sum by (le) (rate(${metric}_bucket{${SERVERS}}[${RATE}])))`, `p${q * 100}`]);
}

const worth = [
  tile("Machine hours saved", "Head travel time saved in the range shown, at the speeds that the jobs state.", "h",
    `sum by (job) (increase(traverse_idle_seconds_saved_total{${FLEET}}[$__range])) / 3600`),
  tile("Travel saved", "Part of the travel of the orders given that the routes do without, over one hour.", "percentunit",
    `job:traverse_travel_saved:ratio_rate1h{${FLEET}}`),
  tile("Jobs per second", "Jobs ended, of any outcome.", "reqps",
    `sum by (job) (job_code:traverse_jobs:rate5m{${FLEET}})`),
  tile("Failed jobs", "Part of the jobs of one hour that ended by our fault or for want of room. Objective: 0.5 %.", "percentunit",
    `job:traverse_failed_jobs:ratio_rate1h{${FLEET}}`, steps([null, "green"], [0.005, "orange"], [0.072, "red"])),
  tile("Servers ready", "Servers that take jobs.", "none",
    `job:traverse_ready:sum{${FLEET}}`, steps([null, "red"], [1, "orange"], [2, "green"])),
  tile("Invalid routes", "Routes that the validator refused in the range shown. More than none is a bug.", "none",
    `sum by (job) (increase(traverse_invalid_routes_total{${FLEET}}[$__range]))`, steps([null, "green"], [0.5, "red"])),
];

const traffic = [
  chart("Jobs by outcome", "Jobs ended per second, by gRPC status.", "reqps",
    [[`sum by (code) (rate(traverse_jobs_total{${SERVERS}}[${RATE}]))`, "{{code}}"]], { stacked: true }),
  chart("Layers by strategy", "Layers solved per second.", "ops",
    [[`sum by (strategy) (rate(traverse_layers_total{${SERVERS}}[${RATE}]))`, "{{strategy}}"]], { stacked: true }),
  chart("Layers by server", "Layers solved per second; equal lines are a balanced fleet.", "ops",
    [[`sum by (instance) (rate(traverse_layers_total{${SERVERS}}[${RATE}]))`, "{{instance}}"]]),
  chart("Errors by code", "Jobs that did not end with OK, per second.", "reqps",
    [[`sum by (code) (rate(traverse_jobs_total{${SERVERS}, code!="OK"}[${RATE}]))`, "{{code}}"]]),
  chart("Refused by reason", "Jobs refused before any work, per second.", "reqps",
    [[`sum by (reason) (rate(traverse_rejected_total{${SERVERS}}[${RATE}]))`, "{{reason}}"]]),
  chart("Jobs in flight", "Jobs accepted and not ended.", "none",
    [[`traverse_jobs_in_flight{${SERVERS}}`, "{{instance}}"]]),
];

const latency = [
  heat("Job time", "From a job's first message to its last; colour is jobs per second.",
    `sum by (le) (rate(traverse_job_seconds_bucket{${SERVERS}}[${RATE}]))`),
  heat("Layer time", "Work on one layer; colour is layers per second.",
    `sum by (le) (rate(traverse_layer_solve_seconds_bucket{${SERVERS}}[${RATE}]))`),
  chart("Job time, quantiles", "Interpolated within the histogram's buckets.", "s",
    quantiles("traverse_job_seconds")),
  chart("Layer time, quantiles", "Interpolated within the histogram's buckets.", "s",
    quantiles("traverse_layer_solve_seconds")),
  chart("Job time by strategy, p99", "Over five minutes.", "s",
    [[`job_strategy:traverse_job_seconds:p99_5m{${FLEET}}`, "{{strategy}}"]]),
];

const saturation = [
  chart("Queued layers", "Layers accepted and not yet solved; the autoscaler's measure.", "none",
    [[`traverse_queue_layers{${SERVERS}}`, "{{instance}}"]]),
  chart("Wait of the queue", "Seconds until the queue would be empty if nothing more came.", "s",
    [[`job:traverse_queue_wait:seconds{${FLEET}}`, "{{job}}"]]),
  chart("Workers busy", "Part of the workers that run a task.", "percentunit",
    [[`traverse_workers_busy{${SERVERS}} / traverse_workers{${SERVERS}}`, "{{instance}}"]], { max: 1 }),
  chart("CPU", "Cores in use by the process.", "none",
    [[`rate(process_cpu_seconds_total{${SERVERS}}[${RATE}])`, "{{instance}}"]]),
  chart("Memory", "Resident memory of the process.", "bytes",
    [[`process_resident_memory_bytes{${SERVERS}}`, "{{instance}}"]]),
  chart("Open files", "File descriptors in use; a connection takes one.", "none",
    [[`process_open_fds{${SERVERS}}`, "{{instance}}"]]),
];

const quality = [
  chart("Travel given and left", "Metres of travel per second of the orders given and of the routes.", "none",
    [[`sum(rate(traverse_travel_given_mm_total{${SERVERS}}[${RATE}])) / 1000`, "given (m/s)"],
     [`sum(rate(traverse_travel_mm_total{${SERVERS}}[${RATE}])) / 1000`, "left (m/s)"]]),
  chart("Stop reasons", "Why the search of a layer ended: many TIME_LIMIT mean that deadlines or cores are short.", "percentunit",
    [[`sum by (stop) (rate(traverse_layers_total{${SERVERS}}[${RATE}])) / ignoring(stop) group_left sum(rate(traverse_layers_total{${SERVERS}}[${RATE}]))`, "{{stop}}"]],
    { stacked: true, max: 1 }),
  chart("Gap to the optimum", "Of layers with a lower bound; 0 is proven optimal.", "percentunit",
    quantiles("traverse_optimality_gap_ratio")),
  withQueries(new table.PanelBuilder().title("Servers").description("Version and hours since the start of each server.")
    .height(6).span(24).transformations([
      { id: "merge", options: {} },
      { id: "organize", options: {
        excludeByName: { Time: true, __name__: true },
        renameByName: { "Value #A": "ready", "Value #B": "hours up" } } },
    ]),
    [[`traverse_ready{${SERVERS}} * on (job, instance) group_left (version) traverse_build_info{${SERVERS}}`],
     [`(time() - process_start_time_seconds{${SERVERS}}) / 3600 * on (job, instance) group_left (version) traverse_build_info{${SERVERS}}`]],
    { instant: true, format: prometheus.PromQueryFormat.Table }),
];

const gateway = [
  chart("Files by outcome", "Files worked on per second. Refused are those of no slicer and those that would not print the same.", "ops",
    [[`sum by (outcome) (rate(traverse_gateway_files_total{${SERVERS}}[${RATE}]))`, "{{outcome}}"]], { stacked: true }),
  chart("Files for printers", "Uploads per second, by what went on to the printer and why.", "ops",
    [[`sum by (printer, outcome, reason) (rate(traverse_gateway_uploads_total{${SERVERS}}[${RATE}]))`, "{{printer}} {{outcome}} {{reason}}"]],
    { stacked: true }),
  chart("Time of requests, quantiles", "From a request's head to its answer; of files the upload and the wait are in it.", "s",
    quantiles("traverse_gateway_request_seconds")),
  chart("Files under way", "Requests with files, and those of them that wait for a worker; the autoscaler's measure.", "none",
    [[`traverse_gateway_requests_in_flight{${SERVERS}}`, "{{instance}}"],
     [`traverse_gateway_requests_waiting{${SERVERS}}`, "{{instance}}, waiting"]]),
  chart("Spool", "Bytes of uploads and answers on disk.", "bytes",
    [[`traverse_gateway_spool_bytes{${SERVERS}}`, "{{instance}}"]]),
  chart("Print time saved", "Hours of estimated print time saved per hour, of all files rewritten.", "none",
    [[`sum(rate(traverse_gateway_print_seconds_saved_total{${SERVERS}}[${RATE}]))`, "saved"]]),
];

const board = new dashboard.DashboardBuilder("Traverse")
  .uid("traverse-fleet").description("Route optimisation for a print farm: worth, traffic, latency, saturation, quality, files.")
  .tags(["traverse", "3d-printing"]).timezone("browser").refresh("30s").time({ from: "now-3h", to: "now" })
  .tooltip(dashboard.DashboardCursorSync.Crosshair)
  .withVariable(new dashboard.DatasourceVariableBuilder("datasource").label("Data source").type("prometheus"))
  .withVariable(new dashboard.QueryVariableBuilder("job").label("Fleet").datasource(SOURCE)
    .query("label_values(traverse_build_info, job)").refresh(dashboard.VariableRefresh.OnTimeRangeChanged)
    .includeAll(true).multi(true).allValue(".+").current({ text: "All", value: "$__all" }))
  .withVariable(new dashboard.QueryVariableBuilder("instance").label("Server").datasource(SOURCE)
    .query('label_values(traverse_build_info{job=~"$job"}, instance)').refresh(dashboard.VariableRefresh.OnTimeRangeChanged)
    .includeAll(true).multi(true).allValue(".+").current({ text: "All", value: "$__all" }))
  .annotation(new dashboard.AnnotationQueryBuilder().name("Alerts").datasource(SOURCE).enable(true).iconColor("red")
    .expr('ALERTS{alertname=~"Traverse.+", alertstate="firing"}'));

let id = 0;
for (const [title, panels] of Object.entries({
  "Worth": worth, "Traffic": traffic, "Latency": latency, "Saturation": saturation, "Quality": quality,
  "Gateway": gateway })) {
  board.withRow(new dashboard.RowBuilder(title).id(++id));
  for (const panel of panels) board.withPanel(panel.id(++id));
}

const target = process.argv[2] ?? fileURLToPath(new URL("traverse.json", import.meta.url));
writeFileSync(target, JSON.stringify(board.build(), null, 2) + "\n");
