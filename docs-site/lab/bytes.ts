// The part of the TypeScript package for the byte view of every page. VitePress loads with each page all modules that
// such a component imports, and `fc.ts` would import the whole protocol.

export { hex, hexByte } from '../../stubs/typescript/src/bytes.ts'
