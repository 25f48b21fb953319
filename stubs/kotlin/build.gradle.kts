import org.jetbrains.kotlin.gradle.dsl.ExplicitApiMode
import org.jetbrains.kotlin.gradle.dsl.JvmTarget

plugins {
    kotlin("jvm") version "2.4.20" apply false
}

subprojects {
    apply(plugin = "org.jetbrains.kotlin.jvm")

    repositories { mavenCentral() }

    dependencies { "api"("org.jetbrains.kotlinx:kotlinx-coroutines-core:1.10.2") }

    configure<JavaPluginExtension> {
        sourceCompatibility = JavaVersion.VERSION_1_8
        targetCompatibility = JavaVersion.VERSION_1_8
    }

    configure<org.jetbrains.kotlin.gradle.dsl.KotlinJvmProjectExtension> {
        if (project.name != "examples") explicitApi = ExplicitApiMode.Strict
        compilerOptions {
            jvmTarget.set(JvmTarget.JVM_1_8)
            allWarningsAsErrors.set(true)
            freeCompilerArgs.add("-Xjdk-release=1.8")
        }
    }
}

project(":generated") { dependencies { "api"(project(":runtime")) } }

project(":examples") { dependencies { "implementation"(project(":generated")) } }
