// The TypeScript package of the protocol. Only this file and `bytes.ts` know its path.

export * from '../../stubs/typescript/src/codec.ts'
export { md5 } from '../../stubs/typescript/src/md5.ts'
