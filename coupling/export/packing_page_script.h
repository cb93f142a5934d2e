// The page of packing_page.cc before and after its data.
#pragma once

namespace grainfield::coupling {

/// With {title}, a JSON text; curly brackets of its own stand twice.
inline constexpr const char* kPackingPageHead = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Packing</title>
<link rel="icon" href="data:,">
<style>
html, body {{ margin: 0; height: 100%; overflow: hidden; font: 13px sans-serif; color: #222; }}
canvas {{ display: block; width: 100%; height: 100%; cursor: grab; }}
#bar {{ position: absolute; left: 10px; top: 8px; background: #ffffffdd; padding: 6px 10px; border-radius: 4px; }}
#bar h1 {{ font-size: 14px; margin: 0 0 4px; }}
#tip {{ position: absolute; display: none; background: #fffffff0; border: 1px solid #999; border-radius: 4px;
       padding: 5px 8px; pointer-events: none; white-space: pre; }}
#scale {{ display: inline-block; width: 120px; height: 9px; vertical-align: middle; margin: 0 4px; }}
</style></head><body>
<canvas id="view"></canvas>
<div id="bar"><h1 id="title"></h1>
<label>colour <select id="by"></select></label> <span id="least"></span><span id="scale"></span><span id="most"></span><br>
<label><input type="checkbox" id="forces" checked> contact forces</label><br>
<span id="help">the wheel zooms, drag moves, the pointer on a grain shows its numbers</span></div>
<div id="tip"></div>
<script>
"use strict";
document.getElementById("title").textContent = {title};
)html";

/// Data: dim, grains [id, x, y(, z), radius, mean stress, contacts, speed, fixed, [corners]],
/// contacts [centre, end, normal force].
inline constexpr const char* kPackingPageScript = R"html(
const space = dim === 3, at = 1 + dim;  // at: where a grain's radius stands
const quantities = [
  ["mean stress (" + (space ? "Pa" : "N/m") + ", compression)", g => g[at + 1]],
  ["contacts", g => g[at + 2]], ["speed (m/s)", g => g[at + 3]], ["radius (m)", g => g[at]]];
const canvas = document.getElementById("view"), pen = canvas.getContext("2d");
const by = document.getElementById("by"), forces = document.getElementById("forces"), tip = document.getElementById("tip");
for (const [name] of quantities) by.add(new Option(name));
document.getElementById("help").textContent =
  "the wheel zooms, " + (space ? "drag turns, shift and drag moves" : "drag moves") +
  ", double click shows all; the pointer on a grain shows its numbers; lines: normal forces, as wide as they are large";

// Turns about the vertical (z) and tilts; in the plane x, y as they are.
let yaw = 0.5, tilt = 0.3, zoom = 1, midX = 0, midY = 0;
function seen(x, y, z) {
  if (!space) return [x, y, 0];
  const c = Math.cos(yaw), s = Math.sin(yaw), u = c * x + s * y, v = -s * x + c * y;
  const ct = Math.cos(tilt), st = Math.sin(tilt);
  return [u, ct * z + st * v, st * z - ct * v];  // right, up, towards the eye
}
const place = g => seen(g[1], g[2], space ? g[3] : 0);
function fit() {
  let l = Infinity, r = -Infinity, b = Infinity, t = -Infinity;
  for (const g of grains) {
    const [x, y] = place(g), R = g[at];
    l = Math.min(l, x - R); r = Math.max(r, x + R); b = Math.min(b, y - R); t = Math.max(t, y + R);
  }
  midX = (l + r) / 2; midY = (b + t) / 2;
  zoom = 0.92 * Math.min(canvas.width / (r - l || 1), (canvas.height - 130 * devicePixelRatio) / (t - b || 1));
}
const toScreen = ([x, y]) => [canvas.width / 2 + zoom * (x - midX), canvas.height / 2 + 40 * devicePixelRatio - zoom * (y - midY)];

const stops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];  // viridis
function colour(share) {
  const s = Math.max(0, Math.min(1, share)) * 4, k = Math.min(3, Math.floor(s)), f = s - k;
  return "rgb(" + stops[k].map((a, c) => Math.round(a + f * (stops[k + 1][c] - a))).join(",") + ")";
}
document.getElementById("scale").style.background =
  "linear-gradient(to right," + stops.map(s => "rgb(" + s + ")").join(",") + ")";
let least = 0, most = 1;
const short = v => v === null ? "-" : Number(v.toPrecision(4)).toString();
function rescale() {
  // Between the second and the 98th hundredth, so that single grains do not take the colours.
  const values = grains.map(quantities[by.selectedIndex][1]).filter(v => v !== null).sort((a, b) => a - b);
  least = values[Math.floor(0.02 * (values.length - 1))] ?? 0;
  most = values[Math.ceil(0.98 * (values.length - 1))] ?? 1;
  document.getElementById("least").textContent = short(least);
  document.getElementById("most").textContent = short(most);
}
const largest = contacts.reduce((m, c) => Math.max(m, c[2 * dim]), 0) || 1;
const usual = grains.length ? grains.map(g => g[at]).sort((a, b) => a - b)[grains.length >> 1] : 1;

function path(g, x, y) {
  pen.beginPath();
  const corners = g[at + 5];
  if (corners.length === 0) { pen.arc(x, y, Math.max(0.3, zoom * g[at]), 0, 2 * Math.PI); return; }
  for (let k = 0; k < corners.length; k += 2) pen.lineTo(x + zoom * corners[k], y - zoom * corners[k + 1]);
  pen.closePath();
}
let drawn = [];  // [grain, x, y], the hindmost first
function draw() {
  pen.clearRect(0, 0, canvas.width, canvas.height);
  const value = quantities[by.selectedIndex][1];
  drawn = grains.map(g => { const p = place(g); return [g, ...toScreen(p), p[2]]; });
  if (space) drawn.sort((a, b) => a[3] - b[3]);
  pen.lineWidth = Math.min(1, zoom * usual / 8);
  for (const [g, x, y] of drawn) {
    const R = zoom * g[at] * 1.5;
    if (x < -R || y < -R || x > canvas.width + R || y > canvas.height + R) continue;
    path(g, x, y);
    const v = value(g);
    pen.fillStyle = g[at + 4] ? "#bbb" : v === null ? "#eee" : colour((v - least) / (most - least || 1));
    pen.globalAlpha = space ? 1 : 0.75;
    pen.fill();
    pen.globalAlpha = 1;
    pen.strokeStyle = space ? "#0006" : "#444";
    pen.stroke();
  }
  if (forces.checked) {
    pen.strokeStyle = "#b40426";
    pen.lineCap = "round";
    for (const c of contacts) {
      const width = zoom * usual * c[2 * dim] / largest;
      if (width < 0.15) continue;
      const [x, y] = toScreen(seen(c[0], c[1], space ? c[2] : 0)), [u, v] = toScreen(seen(c[dim], c[dim + 1], space ? c[dim + 2] : 0));
      pen.lineWidth = width;
      pen.globalAlpha = space ? 0.35 : 0.8;
      pen.beginPath(); pen.moveTo(x, y); pen.lineTo(u, v); pen.stroke();
    }
    pen.globalAlpha = 1;
  }
}
function under(x, y) {
  for (let k = drawn.length - 1; k >= 0; --k) {
    const [g, u, v] = drawn[k], R = zoom * g[at];
    if (Math.hypot(x - u, y - v) > R) continue;
    if (g[at + 5].length === 0) return g;
    path(g, u, v);
    if (pen.isPointInPath(x, y)) return g;
  }
  return null;
}
function say(event) {
  const r = devicePixelRatio, g = under(event.clientX * r, event.clientY * r);
  tip.style.display = g ? "block" : "none";
  if (!g) return;
  tip.textContent = "grain " + g[0] + (g[at + 4] ? " (fixed)" : "") + "\ncentre " + g.slice(1, at).map(short).join(", ") + " m\n" +
    quantities.map(([name, of]) => name + ": " + short(of(g))).join("\n");
  tip.style.left = Math.min(event.clientX + 14, innerWidth - 230) + "px";
  tip.style.top = Math.min(event.clientY + 14, innerHeight - 120) + "px";
}
function resize() {
  const first = canvas.width === 300 && canvas.height === 150, w = canvas.width;
  canvas.width = innerWidth * devicePixelRatio; canvas.height = innerHeight * devicePixelRatio;
  if (first || w === 0) fit();
  draw();
}
let held = null;
canvas.addEventListener("pointerdown", e => { held = e; canvas.setPointerCapture(e.pointerId); tip.style.display = "none"; });
canvas.addEventListener("pointerup", () => { held = null; });
canvas.addEventListener("pointermove", e => {
  if (!held) { say(e); return; }
  const dx = (e.clientX - held.clientX) * devicePixelRatio, dy = (e.clientY - held.clientY) * devicePixelRatio;
  held = e;
  if (space && !e.shiftKey) {
    yaw += dx / 200; tilt = Math.max(-1.57, Math.min(1.57, tilt + dy / 200));
  } else { midX -= dx / zoom; midY += dy / zoom; }
  draw();
});
canvas.addEventListener("wheel", e => {
  e.preventDefault();
  const r = devicePixelRatio, x = e.clientX * r - canvas.width / 2, y = canvas.height / 2 + 40 * r - e.clientY * r;
  const by = Math.exp(-e.deltaY / 500);
  midX += x / zoom - x / (zoom * by); midY += y / zoom - y / (zoom * by);
  zoom *= by;
  draw();
}, {passive: false});
canvas.addEventListener("dblclick", () => { fit(); draw(); });
by.addEventListener("change", () => { rescale(); draw(); });
forces.addEventListener("change", draw);
addEventListener("resize", resize);
forces.checked = !space;
rescale();
resize();
</script></body></html>
)html";

}  // namespace grainfield::coupling
