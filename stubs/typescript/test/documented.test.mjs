// Every public item and each of its members has a comment, in the declarations that the compiler writes.

import assert from 'node:assert/strict'
import { readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { root } from './support.mjs'

const ITEM = /^export (?:declare )?(?:abstract )?(?:interface|type|const|let|function|class|enum|namespace) (\w+)/
const MEMBER = /^ +(?:(?:readonly|static|abstract|protected|get|set) )*([\w$]+|"[^"]+"|\[[^\]]+\])\??(?:[:(<]|$)/

/**
 * Returns the items and members of a declaration file without a comment in front. One comment covers all forms of a
 * union.
 */
function bare(declarations) {
  const lines = declarations.split('\n')
  let isUnion = false
  return lines.flatMap((line, index) => {
    if (ITEM.test(line)) isUnion = /^export type \w+(?:<\w+>)? =/.test(line)
    const inComment = /^\s*(?:\*|\/\*)/.test(line) || (isUnion && /^ /.test(line))
    const found = inComment ? null : (ITEM.exec(line) ?? MEMBER.exec(line))
    const before = index === 0 ? '' : lines[index - 1].trimEnd()
    return found && !before.endsWith('*/') ? [found[1]] : []
  })
}

for (const folder of ['src', 'generated']) {
  for (const file of readdirSync(path.join(root, folder), { recursive: true }).filter((name) => name.endsWith('.ts'))) {
    test(`${folder}/${file}`, () => {
      const place = path.join(root, 'dist', folder, file.replace(/\.ts$/, '.d.ts'))
      assert.deepEqual(bare(readFileSync(place, 'utf8')), [])
    })
  }
}

test('items without a comment are listed', () => {
  const declarations = `
/** Has one. */
export interface A {
    /** Has one, too. */
    a: string;
    b?: number;
    readonly c: {
        /** Has one. */
        d: string;
        e: string;
    };
    f(x: number): void;
}
export declare const g: A;
/**
 * Has a long one.
 */
export declare function h(): void;
export declare class I extends Error {
    /** Has one. */
    j: string;
    constructor(x: string);
}
export type K = 'x' | 'y';
export { l } from './l.ts';
`
  assert.deepEqual(bare(declarations), ['b', 'c', 'e', 'f', 'g', 'I', 'constructor', 'K'])
})
