import org.jetbrains.kotlin.gradle.dsl.ExplicitApiMode
import org.jetbrains.kotlin.gradle.dsl.JvmTarget

plugins {
    kotlin("jvm") apply false
}

val artifact: String by project
val coroutinesVersion: String by project

subprojects {
    apply(plugin = "org.jetbrains.kotlin.jvm")

    repositories { mavenCentral() }

    dependencies { "api"("org.jetbrains.kotlinx:kotlinx-coroutines-core:$coroutinesVersion") }

    configure<JavaPluginExtension> {
        sourceCompatibility = JavaVersion.VERSION_1_8
        targetCompatibility = JavaVersion.VERSION_1_8
    }

    configure<org.jetbrains.kotlin.gradle.dsl.KotlinJvmProjectExtension> {
        if (project.name != "$artifact-examples") explicitApi = ExplicitApiMode.Strict
        compilerOptions {
            jvmTarget.set(JvmTarget.JVM_1_8)
            allWarningsAsErrors.set(true)
            freeCompilerArgs.add("-Xjdk-release=1.8")
        }
    }
}

project(":$artifact-generated") { dependencies { "api"(project(":$artifact-runtime")) } }

project(":$artifact-examples") { dependencies { "implementation"(project(":$artifact-generated")) } }
