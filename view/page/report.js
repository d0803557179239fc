// The report beside the picture: what was solved, how well, and how it got there. Every chart has
// its numbers in a table.

const SVG = 'http://www.w3.org/2000/svg';

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function drawing(name, attributes = {}, text = '') {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

function table(caption, heads, rows) {
  const head = element('tr', {}, ...heads.map((text) => element('th', {scope: 'col'}, text)));
  const body = rows.map(
      (row) => element(
          'tr', {},
          ...row.map(
              (text, k) => element(k ? 'td' : 'th', k ? {} : {scope: 'row'}, String(text)))));
  return element(
      'table', {}, element('caption', {}, caption), element('thead', {}, head),
      element('tbody', {}, ...body));
}

// Powers of ten from below the least to above the largest.
function decades(values) {
  const logs = values.map(Math.log10);
  const low = Math.floor(Math.min(...logs)), high = Math.max(low + 1, Math.ceil(Math.max(...logs)));
  return [low, high];
}

// Points [x, y], both positive, on logarithmic axes.
function chart({title, description, xName, yName, points}) {
  const svg = drawing('svg', {viewBox: '0 0 420 260', role: 'img'});
  svg.append(drawing('title', {}, title), drawing('desc', {}, description));
  const [x0, x1] = decades(points.map((p) => p[0])), [y0, y1] = decades(points.map((p) => p[1]));
  const across = (x) => 60 + 340 * (Math.log10(x) - x0) / (x1 - x0);
  const down = (y) => 215 - 195 * (Math.log10(y) - y0) / (y1 - y0);
  for (let k = x0; k <= x1; ++k) {
    svg.append(drawing(
        'line', {class: 'axis', x1: across(10 ** k), x2: across(10 ** k), y1: 20, y2: 215}));
    svg.append(drawing(
        'text', {x: across(10 ** k), y: 230, 'text-anchor': 'middle'},
        (10 ** k).toLocaleString('en')));
  }
  const step = Math.ceil((y1 - y0) / 8);
  for (let k = y0; k <= y1; k += step) {
    svg.append(
        drawing('line', {class: 'axis', x1: 60, x2: 400, y1: down(10 ** k), y2: down(10 ** k)}));
    svg.append(drawing(
        'text', {x: 54, y: down(10 ** k) + 4, 'text-anchor': 'end'},
        Number((10 ** k).toPrecision(1)).toString()));
  }
  svg.append(drawing('text', {x: 230, y: 250, 'text-anchor': 'middle'}, xName));
  svg.append(drawing(
      'text', {x: 14, y: 118, 'text-anchor': 'middle', transform: 'rotate(-90 14 118)'}, yName));
  svg.append(drawing(
      'polyline',
      {class: 'line', points: points.map(([x, y]) => `${across(x)},${down(y)}`).join(' ')}));
  for (const [x, y] of points)
    svg.append(drawing('circle', {class: 'dot', cx: across(x), cy: down(y), r: 3}));
  return svg;
}

function chartAndTable(options, heads, rows) {
  const usable = options.points.filter((p) => p[0] > 0 && p[1] > 0);
  const parts = usable.length > 1 ? [chart({...options, points: usable})] : [];
  return element(
      'figure', {}, element('figcaption', {}, options.title), ...parts,
      element('div', {class: 'wide'}, table(options.description, heads, rows)));
}

const known = (v, text) => (v === null || v === undefined ? 'not known' : text(v));
const percent = (v) => known(v, (x) => `${figure(100 * x)} %`);

function passesFigure(report) {
  const passes = report.passes || [];
  if (passes.length === 0) return [];
  const costs = passes.some((p) => p.wall_seconds > 0);
  const heads =
      ['Pass', 'Patches', 'Zones', 'Estimated error', ...(costs ? ['Seconds', 'MB'] : [])];
  const rows = passes.map(
      (p) =>
          [p.stage, p.patches, p.zones, percent(p.estimated_error),
           ...(costs ? [figure(p.wall_seconds), Math.round(p.memory_bytes / 1e6)] : [])]);
  return [chartAndTable(
      {
        title: 'How the mesh grew',
        description: 'Elements and estimated error after every pass of refinement',
        xName: 'elements',
        yName: 'estimated error',
        points: passes.map((p) => [p.patches + p.zones, p.estimated_error])
      },
      heads, rows)];
}

function solverFigure(report) {
  const history = (report.solver && report.solver.history) || [];
  if (history.length === 0) return [];
  const first = history.filter((s) => s.band === history[0].band);
  return [chartAndTable(
      {
        title: `How ${report.solver.method} converged`,
        description: 'Residual after iterations of the last linear system',
        xName: 'iterations',
        yName: 'residual',
        points: first.map((s) => [s.iterations, s.residual])
      },
      ['Iterations', 'Residual'],
      first.map((s) => [s.iterations, known(s.residual, (v) => v.toExponential(2))]))];
}

function powersTable(report) {
  const rows =
      Object.entries(report.net_power || {}).map(([name,
                                                   power]) => [name, figures([].concat(power))]);
  return rows.length ? [table(
                           'Net power: what gives light (positive) and what takes it',
                           ['Side or medium', 'W'], rows)] :
                       [];
}

function writeReport(section, meta) {
  const report = meta.report, exponent = (v) => known(v, (x) => x.toExponential(1));
  const solver = report.solver || {};
  section.append(table('The solution', ['What', 'Value'], [
    ['patches', report.patches], ['zones', report.zones],
    ['estimated error', percent(report.estimated_error)],
    [
      'solver',
      `${solver.method}, ${solver.iterations} iterations, residual ${exponent(solver.residual)}${
          solver.converged ? '' : ', not converged'}`
    ],
    ['closure error', exponent(report.closure_error)],
    ['reciprocity error', exponent(report.reciprocity_error)],
    ['energy balance', exponent(report.energy_balance)],
    ['check of direct power', exponent(report.direct_power_check)],
    ...(report.wall_seconds ?
            [
              ['time', `${figure(report.wall_seconds)} s, ${figure(report.cpu_seconds)} CPU s`],
              ['memory', `${Math.round(report.peak_memory_bytes / 1e6)} MB`]
            ] :
            []),
    [
      'pieces of patches for direct light in this page',
      meta.pieces_made + (meta.pieces_left ? `; ${meta.pieces_left} would be finer` : '')
    ],
    ['Tyndall', meta.version]
  ]));
  for (const warning of report.warnings || [])
    section.append(element('p', {class: 'warning'}, `Warning: ${warning}`));
  section.append(...passesFigure(report), ...solverFigure(report), ...powersTable(report));
}
