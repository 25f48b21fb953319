/** The first calls from Kotlin: a query, a command followed to its end, and a robot with one command. */
@file:JvmName("FirstCallInKotlin")

package fc.examples

import fc.Client
import fc.Fc
import fc.GetRobotSnRequest
import fc.GetRobotSnResponse
import fc.PartialRobot
import fc.ResultCode
import fc.StartRechargeRequest
import fc.runtime.CallError
import fc.runtime.ClientConfig
import fc.runtime.Context
import fc.runtime.Followed
import fc.runtime.Server
import fc.runtime.ServerConfig
import fc.service
import kotlinx.coroutines.runBlocking

internal suspend fun ask(config: ClientConfig): Unit = Client.connect(config).use { client ->
    println(client.getRobotSn().data.robotSn)

    client.startRechargeFollowed(StartRechargeRequest {}).asFlow().collect { event ->
        when (event) {
            is Followed.Going, is Followed.Ended, is Followed.Failed -> println(event.report?.data?.rechargeStatus)
            is Followed.Missed -> println("missed ${event.reports}")
            is Followed.Interrupted -> println("no connection: ${event.loss}")
            is Followed.Resumed -> println("connected again: ask for the state")
        }
    }
}

/** A robot that returns its serial number. All other commands are refused as not implemented. */
internal class MyRobot : PartialRobot {
    override suspend fun getRobotSn(context: Context, request: GetRobotSnRequest): GetRobotSnResponse {
        if (context.isAbandoned) throw ResultCode.TIMEOUT.refusal()
        return GetRobotSnResponse.example()
    }
}

internal fun main(): Unit = runBlocking {
    val config = ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0)
    val server = Server.bind(Fc, MyRobot().service(), config)
    try {
        ask(ClientConfig().host("127.0.0.1").commandPort(server.commandAddress.port))
    } catch (error: CallError) {
        println("${error.name}: ${error.refusal?.text}")
    }
    server.close()
}
