// What is wrong with the C++ package, by what Doxygen has printed.

/** Functions, fields and types of the runtime's headers that have no comment. There may be fewer, and never more. */
export const WITHOUT_COMMENT = 53

const GENERATED = 'stubs/cpp/generated/'
/** `… warning: Member limits() const (function) of class fc_runtime::Connection is not documented.` */
const BARE = /warning: (?:Member|Compound) .* is not documented\.$/
const MEMBER = /Member ([\w~]+)\(.* of \w+ (?:\w+::)*(\w+) is not documented\.$/

/** Constructors and operators say what they do by their names. */
const needsNone = (line) => {
  const [, name, owner] = MEMBER.exec(line) ?? []
  return line.includes(': Member operator') || (name !== undefined && name === owner)
}

/**
 * The lines of `printed` that a build must not have. What is generated has a comment everywhere; what Doxygen says of its texts beside
 * that is not here, for they are those of the spec.
 */
export function faults(printed) {
  const lines = printed.split('\n').filter((line) => line.trim() !== '')
  const bare = lines.filter((line) => BARE.test(line) && !needsNone(line))
  const counted = bare.filter((line) => !line.startsWith(GENERATED))
  const wrong = lines.filter((line) => !BARE.test(line) && !line.startsWith(GENERATED))
  const more = counted.length > WITHOUT_COMMENT ? [...counted, `${counted.length} items of the runtime have no comment, and there were ${WITHOUT_COMMENT}`] : []
  return [...bare.filter((line) => line.startsWith(GENERATED)), ...wrong, ...more]
}
