/**
 * A simulated robot for testing apps. It responds to every command with the example in the spec, including commands
 * that would move a real robot. It pushes every report once to each app. It sends the picture of a map over the data
 * port to each app that requests one.
 */
@file:JvmName("Robot")

package fc.examples

import fc.ExampleRobot
import fc.Fc
import fc.GetMapImageRequest
import fc.GetMapImageResponse
import fc.Operations
import fc.runtime.Audience
import fc.runtime.Command
import fc.runtime.Context
import fc.runtime.Message
import fc.runtime.PushError
import fc.runtime.PushErrorKind
import fc.runtime.Report
import fc.runtime.Server
import fc.runtime.ServerConfig
import fc.runtime.Service
import fc.service
import java.net.InetSocketAddress
import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.CountDownLatch
import java.util.concurrent.TimeUnit
import kotlin.system.exitProcess
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.delay
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking

private const val USAGE = """Responds to every command with the example in the spec. Nothing moves: this is for trying out apps.

Usage: run robot [--host 127.0.0.1] [--command-port PORT] [--data-port PORT]
                 [--delay MILLISECONDS] [--gzip-from BYTES] [--picture-scale N]

Without ports, those of the spec; 0 for any that is free. The first line says which:
commands 127.0.0.1:PORT data 127.0.0.1:PORT
The robot ends with Ctrl-C or SIGTERM: what it has begun is answered first. With --delay it takes
so long over each command; with --gzip-from it compresses whatever has so many bytes; with --picture-scale
the picture of a map is so many times as wide and high."""

internal fun main(arguments: Array<String>) {
    val told = Arguments(arguments, USAGE)
    var config = ServerConfig().address(told.host).gzip(told.gzip)
    told.commandPort?.let { config = config.commandPort(it) }
    told.dataPort?.let { config = config.dataPort(it) }
    val attentive = Attentive(told.delay, picture(told.pictureScale))
    val server = try {
        Server.bind(Fc, attentive.service(), config)
    } catch (failure: java.io.IOException) {
        System.err.println(failure.message)
        exitProcess(1)
    }
    attentive.server = server
    // A signal from now on ends the robot after the responses to the current requests.
    Runtime.getRuntime().addShutdownHook(
        Thread {
            runBlocking { server.shutdown(GRACE_SECONDS, TimeUnit.SECONDS) }
            Runtime.getRuntime().halt(0)
        },
    )
    println("commands ${shown(server.commandAddress)} data ${shown(server.dataAddress)}")
    System.out.flush()
    CountDownLatch(1).await()
}

/** Grace period for running handlers at shutdown. */
private const val GRACE_SECONDS = 5L

private fun shown(address: InetSocketAddress) = "${address.address.hostAddress}:${address.port}"

/** Responds with the examples, and sends reports and pictures. */
private class Attentive(private val delay: Long, private val picture: ByteArray) {
    lateinit var server: Server
    private val examples = ExampleRobot(pretendMotion = true)
    private val scope = CoroutineScope(SupervisorJob() + Dispatchers.Default)
    private val known = ConcurrentHashMap.newKeySet<Long>()

    fun service(): Service {
        val service = examples.service()
        for (command in Fc.commands) attend(service, command)
        return service.on(Operations.getMapImage) { context, request -> image(context, request) }
    }

    private fun <Q : Message, A : Message> attend(service: Service, command: Command<Q, A>) {
        service.on(command) { context, _ ->
            meet(context)
            delay(delay)
            command.response.example()
        }
    }

    private suspend fun image(context: Context, request: GetMapImageRequest): GetMapImageResponse {
        meet(context)
        scope.launch { sendPicture(context) }
        return examples.getMapImage(context, request)
    }

    /** Pushes every report to a new app. */
    private fun meet(context: Context) {
        if (!known.add(context.connection)) return
        scope.launch { for (report in Fc.reports) push(report, context.connection) }
    }

    private suspend fun <R : Message> push(report: Report<R>, app: Long) {
        try {
            for (ended in server.push(Audience.one(app), report, report.message.example())) {
                println("${report.name} to ${ended.connection}: ${ended.outcome}")
            }
        } catch (error: PushError) {
            println("${report.name}: ${error.message}")
        }
    }

    /** Sends a picture to the app that requested it, with the id of the request. */
    private suspend fun sendPicture(context: Context) {
        repeat(40) {
            try {
                server.sendStream(Audience.one(context.connection), context.code, context.id, picture)
                println("picture of ${picture.size} bytes to ${context.connection}")
                return
            } catch (error: PushError) {
                // The request may arrive before the data connection of the app.
                if (error.kind != PushErrorKind.NO_CONNECTION) return println("picture: ${error.message}")
                delay(50)
            }
        }
        println("picture: ${context.connection} has no data connection")
    }
}

/** Returns a small map as a portable graymap: a room with a wall around it. */
private fun picture(scale: Int): ByteArray {
    val (width, height) = 64 * scale to 48 * scale
    val pixels = ByteArray(width * height) { index ->
        val (x, y) = index % width to index / width
        if (x == 0 || y == 0 || x == width - 1 || y == height - 1) 0 else 254.toByte()
    }
    return "P5 $width $height 255\n".toByteArray() + pixels
}
