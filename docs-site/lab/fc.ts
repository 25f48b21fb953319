// The TypeScript package of the protocol. This file and `bytes.ts` are what knows where it is.

export * from '../../stubs/typescript/src/codec.ts'
export { md5 } from '../../stubs/typescript/src/md5.ts'
