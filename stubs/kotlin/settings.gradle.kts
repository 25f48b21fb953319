rootProject.name = "fc"

include("runtime", "generated", "examples")
