"use strict";

// The data of the page, and its elements. Text is only ever set as text.

const given = JSON.parse(document.querySelector('script[type="application/json"]').textContent);

const byId = (id) => document.getElementById(id);
const SVG = byId("namespace").namespaceURI;

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}
const html = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);
