// How each run was made: options, inputs, versions, times.
import { el, figure } from "./dom.js";
import { tables } from "./figures.js";

export function originPage(runs, report) {
  return el("main", { class: "page" },
    el("h2", {}, "Options"), el("p", { class: "quiet" }, "Defaults are grey. Where runs differ the row is marked."), options(runs),
    el("h2", {}, "Times"), times(runs),
    el("h2", {}, "Inputs and versions"), sources(runs),
    el("p", { class: "quiet" }, `Written by ${report.program}.`));
}

const stageNames = (runs) => [...new Set(runs.flatMap((run) => run.about.stages.map((record) => record.stage)))];
const recordsOf = (runs, stage) => runs.map((run) => run.about.stages.find((record) => record.stage === stage));

function options(runs) {
  const groups = stageNames(runs).map((stage) => {
    const records = recordsOf(runs, stage);
    const names = [...new Set(records.flatMap((record) => Object.keys(record?.options ?? {})))];
    const rows = names.map((name) => {
      const values = records.map((record) => record?.options?.[name]);
      const differs = new Set(values.map((value) => value?.value)).size > 1;
      return el("tr", { class: differs ? "differs" : "" }, el("th", { scope: "row" }, `--${name}`),
        values.map((value) => el("td", { class: value?.default ? "quiet" : "" }, value === undefined ? "\u2013" : value.value || "none")));
    });
    return { title: stage, rows };
  });
  return groups.length > 0 ? tables(runs, groups) : el("p", {}, "The folders hold no reports of stages.");
}

function times(runs) {
  if (runs.every((run) => !run.about.seconds)) {
    return el("p", {}, "Not recorded: a folder has times where strake remesh --keep made it, and pipelines have them with strake report --pipeline.");
  }
  const names = [...new Set(runs.flatMap((run) => Object.keys(run.about.seconds ?? {})))];
  const order = stageNames(runs);
  // What has no record is the making of a sample, or the writing of a file.
  const place = (name) => (name === "sample" ? -1 : order.includes(name) ? order.indexOf(name) : order.length);
  names.sort((a, b) => place(a) - place(b));
  const write = (value) => (value === undefined ? "\u2013" : `${figure(value)} s`);
  const total = (run) => run.about.seconds && Object.values(run.about.seconds).reduce((sum, value) => sum + value, 0);
  const most = Math.max(...runs.flatMap((run) => Object.values(run.about.seconds ?? {})), 1e-9);
  const cell = (value) => el("td", {}, value !== undefined && el("i", { class: "bar", style: `width:${Math.max((60 * value) / most, 1)}px` }), write(value));
  const rows = names.map((name) => el("tr", {}, el("th", { scope: "row" }, name), runs.map((run) => cell(run.about.seconds?.[name]))));
  rows.push(el("tr", { class: "total" }, el("th", { scope: "row" }, "all stages"), runs.map((run) => el("td", {}, write(total(run))))));
  return tables(runs, [{ rows }]);
}

function sources(runs) {
  return tables(runs, stageNames(runs).map((stage) => {
    const records = recordsOf(runs, stage);
    const roles = [...new Set(records.flatMap((record) => Object.keys(record?.inputs ?? {})))];
    const version = el("tr", {}, el("th", { scope: "row" }, "version of the stage"), records.map((record) => el("td", {}, record ? String(record.stage_version) : "\u2013")));
    const rows = roles.map((role) => el("tr", {}, el("th", { scope: "row" }, role), records.map((record) => el("td", { class: "digest", title: record?.inputs?.[role] }, record?.inputs?.[role] ?? "\u2013"))));
    return { title: stage, rows: [version, ...rows] };
  }));
}
