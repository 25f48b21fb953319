plugins {
    kotlin("jvm") version "2.4.20"
    application
}

repositories {
    maven("../dist/kotlin")
    mavenCentral()
}

dependencies { implementation("fc:fc-generated:${property("fcVersion")}") }

application { mainClass = "AppKt" }
