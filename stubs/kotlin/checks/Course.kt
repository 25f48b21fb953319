@file:Suppress("DEPRECATION")

package course

import fc.runtime.CallError
import fc.runtime.CallOptions
import fc.runtime.ClientConfig
import fc.runtime.Command
import fc.runtime.ConditionError
import fc.runtime.Message
import fc.runtime.Server
import fc.runtime.ServerConfig
import java.math.BigInteger
import java.util.concurrent.TimeUnit.MINUTES
import java.util.concurrent.TimeUnit.SECONDS
import kotlinx.coroutines.runBlocking
import odd_line.A
import odd_line.Client
import odd_line.DriveRequest
import odd_line.Either
import odd_line.ExampleRobot
import odd_line.Far
import odd_line.Going
import odd_line.Here
import odd_line.OddLine
import odd_line.Operations
import odd_line.StrType
import odd_line.service

/** Uses a package with unusual names: calls every command and checks the odd types. */
fun main(): Unit = runBlocking {
    val server = Server.bind(
        OddLine,
        ExampleRobot(pretendMotion = true).service(),
        ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0).handlerTimeout(1, MINUTES),
    )
    val config = ClientConfig().host("127.0.0.1").commandPort(server.commandAddress.port).callTimeout(1, MINUTES)
    Client.connect(config).use { client ->
        for (command in OddLine.commands) call(client, command)
        JavaCourse.use(client)
        val late = runCatching { client.drive(DriveRequest.example(), CallOptions().timeout(0, SECONDS)) }.exceptionOrNull()
        check(late is CallError && late.name == "timeout") { "$late" }
    }
    server.close()

    val request = DriveRequest.example()
    check(request.secret == "it's \"so\" \\ \$站" && request.secret !in request.toString()) { request }
    check(request.secret in request.toBuilder().build().checkedIn().secret)
    check(request.toBuilder == BigInteger("18446744073709551615") && request.content == Long.MIN_VALUE)
    check(request.a == null && A.fromJson("{\"a\":3}").a == 3)
    check(listOf(request.name, request.build, request.checked) == listOf("x", null, true))
    check(DriveRequest { mood(Going.STEPS).secret("s") }.field_OrDefault == 7)
    val why = runCatching { DriveRequest.builder().mood(Going.STEPS).secret("s").checked() }.exceptionOrNull()
    check(why is ConditionError) { "$why" }
    check(Operations.drive.isAcceptedIn(Going.STEPS) && !Operations.drive.isAcceptedIn(Going.NAME))
    val conditions = checkNotNull(Operations.drive.preconditions)
    check(conditions.after.size == 1 && conditions.states.size == 2 && !conditions.isAnyState) { conditions.after }
    check(Going.NAME.mayFollow(Going.STEPS) && !Going.VALUE.mayFollow(Going.STEPS) && Going.COMPANION.isError)
    check(StrType.TEXTS.name == "TEXTS" && StrType.of(9).name == null)
    val here = Here.fromJson("{\"there\":[{\"either\":{\"far\":1},\"going\":\"z\"}]}")
    val either: Either = here.there[0].either
    check(either is Far && either.far == 1)
    println("${OddLine.commands.size} commands were answered")
}

/** Checks a message before it is sent. */
private fun DriveRequest.checkedIn(): DriveRequest = also { it.check() }

private suspend fun <Q : Message, A : Message> call(client: Client, command: Command<Q, A>) {
    val answer = client.connection.call(command, command.request.example())
    check(answer == command.response.example()) { "$command: $answer" }
}
