// The schema in an editor: the language server that Even Better TOML of VS Code has inside is asked as the editor asks it. It marks what is
// misspelt, completes keys, and tells what they mean.
//
//   node language_server.js PROGRAM FOLDER        exit status 77: skipped, as it is not installed (npm install -g @taplo/lsp)
const { execFileSync } = require("child_process");
const fs = require("fs"), path = require("path"), url = require("url");
const [program, folder] = process.argv.slice(2);
let TaploLsp;
try {
  ({ TaploLsp } = require(path.join(execFileSync("npm", ["root", "-g"], { encoding: "utf8" }).trim(), "@taplo/lsp")));
} catch (error) {
  console.log("skipped: @taplo/lsp is not installed");
  process.exit(77);
}
const wait = time => new Promise(resolve => setTimeout(resolve, time));
const until = async (done, what) => {
  for (let i = 0; !done(); ++i) {
    if (i === 150) throw new Error(`no ${what}`);
    await wait(100);
  }
};
const none = async () => { throw new Error("no network"); };
const environment = {
  now: () => new Date(), envVar: name => process.env[name], envVars: () => Object.entries(process.env), stdErrAtty: () => false,
  stdin: async () => new Uint8Array(0), stdout: async bytes => bytes.length, stderr: async bytes => bytes.length, glob: () => [],
  readFile: file => fs.promises.readFile(file), writeFile: (file, bytes) => fs.promises.writeFile(file, bytes),
  urlToFilePath: address => decodeURI(address).slice("file://".length), isAbsolute: path.isAbsolute, cwd: () => folder,
  findConfigFile: () => undefined, fetch: { fetch: none, Headers, Request, Response },
};

async function main() {
  fs.mkdirSync(folder, { recursive: true });
  fs.writeFileSync(path.join(folder, "backlight.schema.json"), execFileSync(program, ["schema"]));
  const answers = new Map(), told = {};
  let number = 0, asked = false;
  const server = await TaploLsp.initialize(environment, { onMessage: message => {
    if (message.method === "workspace/configuration") {
      server.send({ jsonrpc: "2.0", id: message.id, result: message.params.items.map(() => ({ schema: { enabled: true, catalogs: [] } })) });
      asked = true;
    } else if (message.method === "textDocument/publishDiagnostics") {
      told[message.params.uri] = message.params.diagnostics;
    } else if (message.id !== undefined) {
      answers.set(message.id, message.result);
    }
  } });
  const ask = async (method, params) => {
    const id = ++number;
    server.send({ jsonrpc: "2.0", id, method, params });
    await until(() => answers.has(id), `answer to ${method}`);
    return answers.get(id);
  };
  const rootUri = url.pathToFileURL(folder).href;
  await ask("initialize", { processId: process.pid, rootUri, workspaceFolders: [{ uri: rootUri, name: "scenes" }],
    capabilities: { workspace: { configuration: true, workspaceFolders: true } } });
  server.send({ jsonrpc: "2.0", method: "initialized", params: {} });
  await until(() => asked, "question for the configuration");
  await wait(500);
  const open = (name, lines) => {
    const uri = `${rootUri}/${name}`;
    server.send({ jsonrpc: "2.0", method: "textDocument/didOpen",
      params: { textDocument: { uri, languageId: "toml", version: 1, text: ["#:schema backlight.schema.json", ...lines, ""].join("\n") } } });
    return { uri };
  };

  const wrong = open("wrong.toml", ["[film]", "sampels = 4", "[camera]", "[[object]]", 'shape = "sphere"', "size = [1, 1, 1]"]);
  await until(() => told[wrong.uri]?.length, "mark at a misspelt key");
  const marks = JSON.stringify(told[wrong.uri]);
  for (const word of ["sampels", "size"]) if (!marks.includes(word)) throw new Error(`'${word}' is not marked: ${marks}`);

  const textDocument = open("right.toml", ["[film]", "samples = 4", "", "[camera]", "", "[[object]]", 'shape = "sphere"', "radius = 1", ""]);
  for (const [line, key] of [[3, "resolution"], [5, "look_at"], [9, "material"]]) {
    const found = await ask("textDocument/completion", { textDocument, position: { line, character: 0 } });
    const labels = (found?.items ?? found ?? []).map(item => item.label);
    if (!labels.includes(key)) throw new Error(`line ${line} is not completed by '${key}', but: ${labels}`);
  }
  const meaning = await ask("textDocument/hover", { textDocument, position: { line: 2, character: 3 } });
  if (!meaning?.contents.value.includes("Samples a pixel")) throw new Error(`no meaning of 'samples': ${JSON.stringify(meaning)}`);
  if (told[textDocument.uri]?.length) throw new Error(`marked, and right: ${JSON.stringify(told[textDocument.uri])}`);
  console.log("Keys are completed, explained, and marked where they are misspelt.");
}

main().then(() => process.exit(0), error => { console.error(error); process.exit(1); });
process.on("uncaughtException", error => { console.error(String(error).slice(0, 500)); process.exit(1); });
