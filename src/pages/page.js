// Builds each chart when it comes into view. Those over the same axis share its x: a drag zooms all of them, a double
// click shows all again.
(() => {
  'use strict';
  const Y_AXIS_PX = 70, CHARACTER_PX = 7;
  const X_LABEL_PX = 50, Y_LABEL_PX = 27;    // the least room for a tick
  const FONT = '12px system-ui, sans-serif';
  const MARGIN = 0.05;                       // of the range of y, above and below
  const FEW_POINTS = 40;                     // so few get a dot each
  let zooming = false;

  const axes = new Map();
  for (const [name, [min, max]] of Object.entries(JSON.parse(document.body.dataset.axes))) {
    axes.set(name, {all: {min, max}, shown: {min, max}, built: new Set()});
  }
  const axisOf = (spec) => {
    if (!axes.has(spec.axis)) axes.set(spec.axis, {all: {min: 0, max: 1}, shown: {min: 0, max: 1}, built: new Set()});
    return axes.get(spec.axis);
  };

  const numbers = (packed, unit) => {
    let steps = 0;
    return packed.v.map((d) => (d === null ? null : (packed.o + packed.s * (steps += d)) / unit));
  };
  // The library draws no axis for numbers of 17 digits: larger ones are drawn in units of a power of ten.
  const unitOf = (tracks) => {
    const largest = tracks.flatMap((track) => track.y.flatMap((packed) => numbers(packed, 1)))
        .reduce((most, value) => Math.max(most, Math.abs(value ?? 0)), 0);
    return largest < 1e15 ? 1 : Math.pow(10, Math.floor(Math.log10(largest)));
  };
  const text = (value) => (value == null ? '-' : String(+value.toPrecision(5)));

  // The same rules as in axis.cpp.
  const exponent = (value) => Math.floor(Math.log10(Math.abs(value)) + 1e-9);
  const shownRange = (min, max, margin) => {
    if (min == null || max == null || !(min <= max)) return [0, 1];
    const largest = Math.max(Math.abs(min), Math.abs(max));
    if (largest < 1e-290) return [-1, 1];
    const span = max - min, least = span > 0 ? 65536 * Number.EPSILON * largest : 0.2 * largest;
    const beyond = Math.max(margin * span, 0.5 * (least - span));
    return [min - beyond, max + beyond];
  };
  const tickStep = (span, count) => {
    const rough = span / count, decade = Math.pow(10, Math.floor(Math.log10(rough)));
    for (const factor of [1, 2, 5]) if (factor * decade >= rough * (1 - 1e-9)) return factor * decade;
    return 10 * decade;
  };
  const stepOf = (min, max, count) => {
    let step = tickStep(max - min, count);
    // One tick alone tells no scale.
    while (Math.floor(max / step + 1e-9) - Math.ceil(min / step - 1e-9) < 1) step = tickStep(max - min, ++count);
    return step;
  };
  const ticks = (min, max, count) => {
    const step = stepOf(min, max, count), values = [], last = Math.floor(max / step + 1e-9);
    for (let k = Math.ceil(min / step - 1e-9); k <= last && values.length <= 2 * count; ++k) values.push(k * step);
    return values;
  };
  const scientific = (value, lastDigit) => {
    if (value === 0) return '0';
    const digits = Math.min(16, Math.max(0, exponent(value) - lastDigit));
    return value.toExponential(digits).replace('e+', 'e');
  };
  const labels = (values, min, max, count) => {
    const lastDigit = exponent(stepOf(min, max, count));
    const decimals = Math.max(0, -lastDigit);
    // A fixed number of 100 decimals or of 21 digits before the point is more than the language writes, and any reader.
    const writable = decimals <= 100 && Math.max(Math.abs(min), Math.abs(max)) < 1e21;
    const exponential = values.map((v) => scientific(v, lastDigit));
    if (!writable) return exponential;
    const fixed = values.map((v) => (v === 0 ? 0 : v).toFixed(decimals));
    const longest = (all) => Math.max(0, ...all.map((label) => label.length));
    return longest(exponential) + 3 < longest(fixed) ? exponential : fixed;
  };

  // As many ticks as their labels have room for.
  const xCount = ({min, max}, width, unit) => {
    for (let count = Math.floor(width / X_LABEL_PX); count > 2; --count) {
      const longest = Math.max(...labels(ticks(min, max, count), min, max, count).map((label) => label.length));
      const room = width * stepOf(min, max, count) / (max - min);
      if (CHARACTER_PX * (longest + unit.length + 3) <= room) return count;
    }
    return 2;
  };

  const zoom = (axis, min, max, from) => {
    if (zooming || (min === axis.shown.min && max === axis.shown.max)) return;
    zooming = true;
    Object.assign(axis.shown, {min, max});
    for (const plot of axis.built) if (plot !== from) plot.setScale('x', {min, max});
    zooming = false;
  };

  const clipped = (u, draw) => {
    const {ctx, bbox} = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    // A canvas has more pixels than the page on many screens.
    const px = devicePixelRatio;
    ctx.font = `${12 * px}px system-ui, sans-serif`;
    ctx.lineWidth = px;
    draw(ctx, bbox, (x) => u.valToPos(x, 'x', true), px);
    ctx.restore();
  };
  const drawBands = (spec) => (u) => clipped(u, (ctx, box, at, px) => {
    for (const [from, to, colour] of spec.bands) {
      ctx.fillStyle = colour;
      ctx.fillRect(at(from), box.top, Math.max(px, at(to) - at(from)), box.height);
    }
  });
  // Lines below stay off the words.
  const halo = (ctx, words, x, y, px) => {
    ctx.save();
    ctx.strokeStyle = 'rgba(255, 255, 255, 0.85)';
    ctx.lineWidth = 4 * px;
    ctx.lineJoin = 'round';
    ctx.strokeText(words, x, y);
    ctx.restore();
    ctx.fillText(words, x, y);
  };
  const drawMarks = (spec) => (u) => clipped(u, (ctx, box, at, px) => {
    ctx.textBaseline = 'alphabetic';
    ctx.strokeStyle = ctx.fillStyle = '#b00020';
    const rows = [];  // of words: where each ends
    for (const [x, words] of [...spec.marks].sort((a, b) => a[0] - b[0])) {
      ctx.beginPath();
      ctx.moveTo(at(x), box.top);
      ctx.lineTo(at(x), box.top + box.height);
      ctx.stroke();
      const width = ctx.measureText(words).width;
      const left = at(x) + width + 8 * px > box.left + box.width;
      const begin = left ? at(x) - 4 * px - width : at(x) + 4 * px;
      let row = rows.findIndex((end) => end < begin);
      if (row < 0) row = rows.length;
      rows[row] = begin + width;
      const y = spec.lanes ? box.top + box.height - (8 + 13 * row) * px : box.top + (12 + 13 * row) * px;
      ctx.textAlign = 'left';
      halo(ctx, words, begin, y, px);
    }
  });
  // As much as there is room for; a number alone rather than it and a letter or two.
  const fitted = (ctx, words, width) => {
    const fits = (text) => ctx.measureText(text).width <= width;
    if (fits(words)) return words;
    const number = (/^\d+(?= )/.exec(words) ?? [''])[0];
    for (let n = words.length - 1; n > (number ? number.length + 3 : 0); --n) {
      const shorter = words.slice(0, n).trimEnd() + '…';
      if (fits(shorter)) return shorter;
    }
    if (fits(number)) return number;
    return '';
  };
  const drawLanes = (spec) => (u) => clipped(u, (ctx, box, at, px) => {
    const height = box.height / spec.lanes.length;
    ctx.textBaseline = 'middle';
    ctx.textAlign = 'left';
    spec.lanes.forEach((lane, i) => {
      const top = box.top + i * height;
      for (const [from, to, words, colour] of lane.stretches) {
        const left = at(from), width = Math.max(px, at(to) - left);
        ctx.fillStyle = colour;
        ctx.fillRect(left, top + 2 * px, width, height - 4 * px);
        const begin = Math.max(left, box.left), end = Math.min(left + width, box.left + box.width);
        ctx.fillStyle = '#1b1f24';
        if (words) ctx.fillText(fitted(ctx, words, end - begin - 6 * px), begin + 4 * px, top + height / 2);
      }
    });
  });

  const data = (spec) => {
    const tables = spec.tracks.map((track) => [numbers(track.x, 1), ...track.y.map((y) => numbers(y, spec.unit))]);
    if (tables.length === 0) return [[axisOf(spec).all.min, axisOf(spec).all.max]];
    return tables.length === 1 ? tables[0] : uPlot.join(tables);
  };

  // Points between gaps: no line would show them. A join of several x leaves undefined between a line's own points.
  const alone = (u, index) => {
    const y = u.data[index], own = [...y.keys()].filter((i) => y[i] !== undefined);
    return own.filter((i, k) => y[i] != null && y[own[k - 1]] == null && y[own[k + 1]] == null);
  };
  // Of the lines that are shown, in the stretch of x that is shown. A line's `widens` bounds what it adds.
  const rangeOf = (u, spec) => {
    const [first, last] = u.series[0].idxs ?? [0, u.data[0].length - 1];
    let range = [null, null];
    spec.lines.forEach((line, i) => {
      if (u.series[i + 1].show === false) return;
      const [from, to] = (line.widens ?? [-Infinity, Infinity]).map((value) => value / spec.unit);
      for (let k = first; k <= last; ++k) {
        const y = u.data[i + 1][k];
        if (y == null) continue;
        const counted = Math.min(Math.max(y, from), to);
        range = [Math.min(range[0] ?? counted, counted), Math.max(range[1] ?? counted, counted)];
      }
    });
    return range;
  };
  // At the edge that a line leaves, how far it goes.
  const drawBeyond = (spec) => (u) => clipped(u, (ctx, box, at, px) => {
    const {min, max} = u.scales.y, [first, last] = u.series[0].idxs ?? [0, -1], rows = {top: 0, bottom: 0};
    spec.lines.forEach((line, i) => {
      if (!line.widens || !u.series[i + 1].show) return;
      let low = null, high = null;
      for (let k = first; k <= last; ++k) {
        const y = u.data[i + 1][k];
        if (y == null) continue;
        if (y > max && (high === null || y > u.data[i + 1][high])) high = k;
        if (y < min && (low === null || y < u.data[i + 1][low])) low = k;
      }
      for (const [k, edge, arrow] of [[high, 'top', '↑'], [low, 'bottom', '↓']]) {
        if (k === null) continue;
        const words = `${line.name} ${text(u.data[i + 1][k] * spec.unit)} ${arrow}`, width = ctx.measureText(words).width;
        const row = rows[edge]++;
        ctx.fillStyle = line.colour;
        ctx.textAlign = 'left';
        ctx.textBaseline = 'alphabetic';
        const begin = Math.max(box.left, Math.min(at(u.data[0][k]) + 4 * px, box.left + box.width - width - 2 * px));
        halo(ctx, words, begin, edge === 'top' ? box.top + (12 + 13 * row) * px : box.top + box.height - (5 + 13 * row) * px, px);
      }
    });
  });
  const countOf = (values) => values.reduce((count, value) => count + (value != null), 0);

  const options = (spec, width) => {
    const lanes = spec.lanes, axis = axisOf(spec);
    const grid = {stroke: '#e6e9ed', width: 1}, tickMarks = {stroke: '#c9ced6', width: 1, size: 4};
    const counts = (u) => ({
      x: xCount(u.scales.x, u.width - Y_AXIS_PX, spec.x_unit),
      y: Math.max(3, Math.floor((u.height - 60) / Y_LABEL_PX)),
    });
    const y = {
      stroke: '#1b1f24', font: FONT, grid, ticks: tickMarks,
      size: (u, values) => Math.max(Y_AXIS_PX, 12 + CHARACTER_PX * Math.max(0, ...(values || []).map((v) => v.length))),
      incrs: [Infinity],  // splits decides; the library's own steps end at 1e-16 and 1e15, and no ticks are drawn then
      splits: (u, index, min, max) => ticks(min, max, counts(u).y),
      values: (u, values) => labels(values.map((v) => v * spec.unit), u.scales.y.min * spec.unit,
                                    u.scales.y.max * spec.unit, counts(u).y),
    };
    if (lanes) {
      const count = lanes.length;
      Object.assign(y, {
        size: Math.max(Y_AXIS_PX, 12 + CHARACTER_PX * Math.max(...lanes.map((lane) => lane.name.length))),
        splits: () => lanes.map((_, i) => count - i - 0.5),
        values: () => lanes.map((lane) => lane.name),
        grid: {show: false}, ticks: {show: false},
      });
    }
    return {
      width,
      height: lanes ? 34 + 26 * lanes.length : spec.height,
      legend: {show: !lanes, markers: {width: 0, fill: (u, i) => u.series[i].stroke()}},
      scales: {
        x: {time: false, range: (u, min, max) => (min < max ? [min, max] : [axis.shown.min, axis.shown.max])},
        y: {range: lanes ? () => [0, lanes.length] : (u) => shownRange(...rangeOf(u, spec), MARGIN)},
      },
      series: [
        {label: spec.x_name, value: (_, v) => text(v) + ' ' + spec.x_unit},
        ...spec.lines.map((line) => ({
          label: line.name, stroke: line.colour, width: line.width, dash: line.dashed ? [6, 4] : undefined,
          paths: line.stepped ? uPlot.paths.stepped({align: 1}) : undefined,
          value: (_, v) => text(v == null ? v : v * spec.unit),
          points: {
            size: 5, width: 0, fill: line.colour, stroke: line.colour,
            show: (u, index) => countOf(u.data[index]) <= FEW_POINTS,
            filter: (u, index, show) => (show ? null : alone(u, index)),
          },
        })),
      ],
      axes: [
        {stroke: '#1b1f24', font: FONT, grid, ticks: tickMarks, size: 26,
         incrs: [Infinity],
         splits: (u, index, min, max) => ticks(min, max, counts(u).x),
         values: (u, values) => labels(values, u.scales.x.min, u.scales.x.max, counts(u).x)
             .map((label) => (spec.x_unit ? `${label} ${spec.x_unit}` : label))},
        y,
      ],
      cursor: {
        y: false,
        drag: {x: true, y: false},
        sync: {key: spec.axis, scales: ['x', null], filters: {pub: (type) => type === 'mousemove', sub: () => true}},
        bind: {dblclick: (u) => () => { u.setScale('x', {...axis.all}); return null; }},
        points: {size: 6},
      },
      hooks: {
        drawClear: [drawBands(spec)],
        draw: [lanes ? drawLanes(spec) : drawBeyond(spec), drawMarks(spec)],
        setScale: [(u, key) => { if (key === 'x') zoom(axis, u.scales.x.min, u.scales.x.max, u); }],
      },
    };
  };

  const build = (place) => {
    const spec = JSON.parse(place.querySelector('script').textContent), axis = axisOf(spec);
    spec.unit = unitOf(spec.tracks);
    zooming = true;
    const plot = new uPlot(options(spec, place.clientWidth), data(spec), place);
    plot.setScale('x', {...axis.shown});
    requestAnimationFrame(() => { zooming = false; });
    axis.built.add(plot);
    place.plot = plot;
    place.style.minHeight = '';
  };

  // Behind each title a button that saves: what is drawn as SVG, the numbers of a chart or of lanes as CSV.
  const cell = (value) => {
    const words = typeof value === 'number' ? String(+value.toPrecision(12)) : String(value ?? '');
    return /[",\n]/.test(words) ? `"${words.replaceAll('"', '""')}"` : words;
  };
  const rowsOf = (spec) => {
    if (spec.lanes) {
      const rows = spec.lanes.flatMap((lane) => lane.stretches.map(([from, to, words]) => [lane.name, words, from, to]));
      return [['row', 'text', `from [${spec.x_unit}]`, `to [${spec.x_unit}]`], ...rows];
    }
    const columns = data({...spec, unit: 1}), names = spec.lines.map((line) => line.name);
    const x = spec.x_unit ? `${spec.x_name} [${spec.x_unit}]` : spec.x_name;
    return [[x, ...names], ...columns[0].map((_, i) => columns.map((column) => column[i]))];
  };
  const svgOf = (shown) => {
    const copy = shown.cloneNode(true), [, , width, height] = copy.getAttribute('viewBox').split(' ');
    copy.setAttribute('width', width);
    copy.setAttribute('height', height);
    copy.setAttribute('style', 'font: 12px system-ui, sans-serif');
    const style = document.createElementNS(copy.namespaceURI, 'style');
    style.textContent = [...document.styleSheets[0].cssRules].map((rule) => rule.cssText)
        .filter((rule) => /^svg [^{]/.test(rule)).join('\n');
    copy.prepend(style);
    return new XMLSerializer().serializeToString(copy);
  };
  const save = (name, type, content) => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([content], {type}));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  };
  for (const picture of document.querySelectorAll('.picture')) {
    const title = picture.querySelector('h3'), button = document.createElement('button');
    const svg = picture.querySelector(':scope > svg'), chart = picture.querySelector('.chart script');
    const name = title.textContent.replace(/[^\p{L}\p{N}]+/gu, '_').replace(/^_|_$/g, '');
    button.textContent = svg ? 'SVG' : 'CSV';
    button.title = svg ? 'save this picture' : 'save the numbers that are drawn';
    button.onclick = () => {
      if (svg) return save(`${name}.svg`, 'image/svg+xml', svgOf(svg));
      const rows = rowsOf(JSON.parse(chart.textContent));
      save(`${name}.csv`, 'text/csv', rows.map((row) => row.map(cell).join(',') + '\n').join(''));
    };
    title.append(button);
  }

  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      seen.unobserve(entry.target);
      build(entry.target);
    }
  }, {rootMargin: '300px'});
  const places = document.querySelectorAll('.chart');
  places.forEach((place) => seen.observe(place));

  let pending = 0;
  addEventListener('resize', () => {
    clearTimeout(pending);
    pending = setTimeout(() => places.forEach((place) => {
      if (place.plot && place.clientWidth > 0) place.plot.setSize({width: place.clientWidth, height: place.plot.height});
    }), 100);
  });
})();
