// Finds errors of the C++ package in the output of Doxygen.

/** The number of items without a comment in the headers of the runtime. It may only fall. */
export const WITHOUT_COMMENT = 53

const GENERATED = 'stubs/cpp/generated/'
/** `… warning: Member limits() const (function) of class fc_runtime::Connection is not documented.` */
const BARE = /warning: (?:Member|Compound) .* is not documented\.$/
const MEMBER = /Member ([\w~]+)\(.* of \w+ (?:\w+::)*(\w+) is not documented\.$/

/** Constructors and operators need no comment. */
const needsNone = (line) => {
  const [, name, owner] = MEMBER.exec(line) ?? []
  return line.includes(': Member operator') || (name !== undefined && name === owner)
}

/**
 * The lines of `printed` that a build must not have. Every generated item has a comment. Other warnings about generated
 * comments are ignored, because their text comes from the spec.
 */
export function faults(printed) {
  const lines = printed.split('\n').filter((line) => line.trim() !== '')
  const bare = lines.filter((line) => BARE.test(line) && !needsNone(line))
  const counted = bare.filter((line) => !line.startsWith(GENERATED))
  const wrong = lines.filter((line) => !BARE.test(line) && !line.startsWith(GENERATED))
  const more = counted.length > WITHOUT_COMMENT ? [...counted, `${counted.length} items of the runtime have no comment, and there were ${WITHOUT_COMMENT}`] : []
  return [...bare.filter((line) => line.startsWith(GENERATED)), ...wrong, ...more]
}
