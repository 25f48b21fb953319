// Schemas made of a protocol as data, for protocols that no package was generated for.

const camel = (key) => key

function typeOf(types, type) {
  if (type.is === 'array') return { list: typeOf(types, type.of) }
  return type.is === 'named' ? types[type.name] : type.is
}

const isLarge = (types, protocol, type) => {
  if (type.is === 'array') return isLarge(types, protocol, type.of)
  if (type.is === 'named') return ['i64', 'u64'].includes(protocol.types[type.name].repr)
  return ['i64', 'u64'].includes(type.is)
}

function isNumeric(protocol, type) {
  if (type.is === 'array') return isNumeric(protocol, type.of)
  return type.is === 'named' ? protocol.types[type.name].repr !== 'string' : true
}

function fieldOf(types, protocol, field) {
  const { min, max, length, pattern } = field
  const large = isLarge(types, protocol, field.type)
  const number = large ? BigInt : Number
  return {
    key: field.key,
    type: typeOf(types, field.type),
    ...(field.optional ? { optional: true } : {}),
    ...(field.also.length ? { also: field.also } : {}),
    ...(field.wireString ? { form: 'string' } : field.wireNumber ? { form: 'number' } : {}),
    ...(min === null ? {} : { min: number(min) }),
    ...(max === null ? {} : { max: number(max) }),
    ...(length === null ? {} : { length }),
    ...(pattern === null ? {} : { pattern }),
    ...(field.only ? { only: field.only.map((wire) => (isNumeric(protocol, field.type) ? number(wire) : wire)) } : {}),
    ...(field.emptyIsAbsent ? { emptyIsAbsent: true } : {}),
    ...(field.lenientNumber ? { lenientNumber: true } : {}),
    ...(field.lenientBool ? { lenientBool: true } : {}),
  }
}

/** A struct of these fields. */
export function structOf(types, protocol, name, fields) {
  const made = fields.map((field) => [camel(field.key), fieldOf(types, protocol, field)])
  return { is: 'struct', name, fields: Object.fromEntries(made) }
}

/** All types of a protocol as schemas, each behind a function. */
export function schemasOf(protocol) {
  const types = {}
  for (const [name, type] of Object.entries(protocol.types)) {
    let made
    types[name] = () => (made ??= make(name, type))
  }
  function make(name, type) {
    if (type.is === 'struct') return structOf(types, protocol, name, type.fields)
    if (type.is === 'one_of') {
      return { is: 'choice', name, forms: Object.fromEntries(type.variants.map((one) => [one.name, types[one.type]])) }
    }
    const read = type.repr === 'string' ? String : type.repr.endsWith('64') ? BigInt : Number
    const values = Object.fromEntries(type.values.map((one) => [one.name, read(one.wire)]))
    return { is: 'enum', name, repr: type.repr, closed: type.closed, values }
  }
  return types
}
