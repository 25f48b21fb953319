pluginManagement {
    val kotlinVersion: String by settings
    plugins { kotlin("jvm") version kotlinVersion }
}

rootProject.name = "fc"

val artifact: String by settings

for (part in listOf("runtime", "generated", "examples")) {
    include("$artifact-$part")
    project(":$artifact-$part").projectDir = file(part)
}
