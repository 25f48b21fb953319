// What the byte view of every page needs of the TypeScript package. By itself: VitePress loads with each page all
// that such a component can reach, and `fc.ts` reaches the whole protocol.

export { hex, hexByte } from '../../stubs/typescript/src/bytes.ts'
