// TypeDoc calls a module by its file; here it has the name by which a program imports it.

import { Converter, ReflectionKind } from 'typedoc'

export function load(app) {
  app.converter.on(Converter.EVENT_RESOLVE_BEGIN, ({ project }) => {
    for (const module of project.getReflectionsByKind(ReflectionKind.Module)) {
      module.name = module.name === 'generated' ? project.name : module.name.replace(/^src\//, `${project.name}/`)
    }
  })
}
