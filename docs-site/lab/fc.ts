// The TypeScript package of the protocol. This file and `bytes.ts` are what knows where it is.

export * from '../../stubs/typescript/src/codec.ts'
