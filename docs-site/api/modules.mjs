// TypeDoc names a module after its file. This plugin uses the name that programs import.

import { Converter, ReflectionKind } from 'typedoc'

export function load(app) {
  app.converter.on(Converter.EVENT_RESOLVE_BEGIN, ({ project }) => {
    for (const module of project.getReflectionsByKind(ReflectionKind.Module)) {
      module.name = module.name === 'generated' ? project.name : module.name.replace(/^src\//, `${project.name}/`)
    }
  })
}
