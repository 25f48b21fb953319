// Prints the values that js-yaml and yaml read in each file, as one JSON object; an error as a text.
import { readFileSync } from 'node:fs';
import { load } from 'js-yaml';
import { parse } from 'yaml';

const read = (reader, text) => {
  try {
    return { value: reader(text) };
  } catch (error) {
    return { refused: String(error.message).split('\n')[0] };
  }
};
const files = process.argv.slice(2).map((path) => {
  const text = readFileSync(path, 'utf8');
  return [path, { 'js-yaml': read(load, text), yaml: read(parse, text) }];
});
console.log(JSON.stringify(Object.fromEntries(files)));
